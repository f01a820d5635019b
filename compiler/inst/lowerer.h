#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/inst/chance.h"
#include "compiler/inst/hues.h"
#include "compiler/inst/index.h"
#include "compiler/inst/ink.h"
#include "compiler/lower/lowering.h"
#include "compiler/lower/model_family.h"
#include "compiler/lower/primitive_objects.h"
#include "compiler/support/counter_random.h"

namespace graftal {

/// The most words of definitions that are evaluated over all enumerated objects and copies: some seconds of
/// work.
inline constexpr std::size_t max_inst_work = 30'000'000;

/// Lowers one `.inst` file. lower.cpp enumerates the objects, names.cpp looks up names, and
/// groups.cpp makes instances of the groups of one object.
class InstLowerer {
  public:
    /// Both must outlive this.
    InstLowerer(const InstModule& module, Lowering& lowering);

    std::optional<Graph> run() &&;

  private:
    /// The place of one copy of a group's instances, or the step that a repeat adds for each copy.
    struct Placement {
        Affine parent_from_child;
        Tint tint;
        std::optional<MaterialId> material;
        HueTurn hue;
        InkChange ink;
    };

    /// An object and how its instances change colours.
    struct Lowered {
        Object object;
        ObjectHues hues;
        ObjectInks inks;

        void add(Instance instance, const Placement& placement);
    };

    /// The lets of the file, and the parameters of one object, which hide lets of their names.
    struct ObjectEnvironment {
        Environment values;
        std::vector<std::string> parameters;
    };

    /// An object of the file and how it was first reached.
    struct Reached {
        ObjectId id = 0;
        const InstDefinition* definition = nullptr;
        std::vector<double> arguments;
        Span use;               ///< the reference that reached it; unknown where nothing did
        std::size_t parent = 0; ///< index of the object that holds the reference; its own where nothing did
        std::uint32_t variant = 0; ///< of a random object
        std::uint64_t key = 0;     ///< of its random numbers: of seed, name and arguments
    };

    bool failed() const { return lowering_.file_failed(); }

    // Names

    void import_used(const UseStatement& use);
    void add_family(const UseStatement& use, FileId file);
    /// `m.bough(2)` of `use m = "wood.inst"`, where it is not in the graph yet; nothing, after an error, if
    /// there is no such object.
    std::optional<ObjectId> part_of_used(std::string_view name, const std::vector<double>& arguments,
                                         Span place);
    /// The object of part_of_used(); if there is none, sets Lowering::part_missing, without a message.
    std::optional<ObjectId> import_called(std::string_view name, const std::vector<double>& arguments);
    /// Most arguments that a used model takes.
    std::size_t inner_count(std::string_view name) const;
    /// The used model that a name stands for or lies in; null for the file's own names.
    const std::pair<const std::string, Span>* use_of(std::string_view name) const;
    void check_names(const InstDefinition& definition);
    /// Reports objects where numbers stand: `scale: 0.5, tip scale: 0.8` goes on with the numbers of the
    /// first line.
    void check_numbers(const std::vector<Expression>& numbers, const InstDefinition& definition);
    /// Reports and gives false if nothing of this name, or not with as many arguments, can exist.
    bool check_reference(const InstReference& reference);
    /// The kind of a primitive that numbers make. The model's own objects of as many arguments hide it, and
    /// used models do.
    std::optional<PrimitiveKind> kind_of(const InstReference& reference) const;
    /// `mesh "leaf.obj"`: read here, once for each file.
    bool check_mesh(const InstReference& reference);
    Diagnostic& wrong_count(const InstReference& reference, std::size_t arity);
    Diagnostic& wrong_count(const InstReference& reference, const std::string& takes);
    void unknown_object(Span span, std::string_view name);

    // Enumeration

    /// The rendered objects and the plain canonical ones, in the order of the text, then what they reach,
    /// breadth first. Canonical objects that are random come only where a reference reaches them.
    void enumerate();
    void call_for(const InstDefinition& definition);
    /// The one object that another file asks for.
    void call_for(const PartCall& part);
    /// The root of a used model, which a model that uses this one asked for by its name.
    std::optional<ObjectId> whole_used(const PartCall& part);
    /// Without a message: Lowering::part_missing.
    std::nullopt_t no_part();
    /// An object that nothing in the file refers to.
    std::optional<ObjectId> add_called(const InstDefinition& definition, std::vector<double> arguments,
                                       const std::string& name);
    std::optional<ObjectId> add_object(Reached reached, const std::string& name);
    /// Ends the enumeration, naming the chain that leads to `name`.
    std::nullopt_t stop(Span use, const InstDefinition& definition, std::size_t parent, std::string_view name,
                        std::string message);
    void lower_object(std::size_t index);
    /// Counts evaluated words; false if they are too many.
    bool count_work(std::size_t words);
    /// Counts the words of an object; too many are an error that names the chain of objects.
    bool work(std::size_t words);
    /// Counts a copy that the repeats of a group make; too many are an error at these repeats.
    bool copy_work(const InstGroup& group);
    /// Gives the environment of an object the parameters of another. O(parameters), however many lets there
    /// are.
    void set_parameters(const InstDefinition& definition, const std::vector<double>& arguments,
                        ObjectEnvironment& environment) const;
    /// Hands on the errors of one object. Its definition is then left alone: for other arguments the same
    /// errors would follow.
    void report(std::size_t index);
    void choose_root();
    /// A note for each object that is drawn by itself and used by another: `canonical` may be forgotten.
    void note_drawn_twice();
    void add_scene(const std::vector<const Reached*>& rendered);
    void keep_colours(ObjectId id, Lowered lowered);

    // Groups

    void lower_group(const InstGroup& group, Lowered& object);
    /// Whether the conditions of a group hold; false after an error.
    bool holds(const InstGroup& group);
    /// Adds the copies that the repeats from `depth` on make, inside the copy `around` of the outer repeats.
    void lower_copies(const InstGroup& group, std::size_t depth, const Placement& around, Lowered& object);
    std::optional<std::size_t> repeat_count(const InstRepeat& repeat);
    std::optional<Placement> lower_step(const InstRepeat& repeat);
    /// Nothing, after an error, if the map leaves the range of numbers.
    std::optional<Placement> composed(const Placement& parent, const Placement& child, Span span);
    /// Whether an object of its own contains the copies of the inner repeats. It does not where it would
    /// count as a level of recursion, where all copies differ, or where each is an operand.
    bool shares_copies(const InstGroup& group) const;
    /// `town.repeat`, `town.repeat2` and so on, for such an object of the one being lowered.
    std::string free_repeat_name();
    void lower_instances(const InstGroup& group, const Placement& around, Lowered& object);
    void lower_scattered(const InstGroup& group, Lowered& object);
    /// 0 where none is stated.
    double lower_chance(const InstGroup& group);
    HueTurn lower_hue(const Expression& hue);
    std::optional<Placement> lower_placement(const InstGroup& group);
    std::optional<Tint> lower_tints(const std::vector<InstTint>& tints);
    std::optional<ObjectId> resolve(const InstReference& reference);
    std::optional<ObjectId> variant_of(const InstDefinition& definition, std::vector<double> arguments,
                                       const std::string& name, Span use);

    // Chance

    bool is_random(const InstGroup& group) const;
    std::uint64_t key_of(std::string_view name) const;
    /// A key for each place of the object being lowered.
    std::uint64_t next_place() { return CounterRandom::scrambled(reached_[current_].key ^ ++place_); }
    /// Random numbers for the calls of a group.
    void draw(const InstGroup& group);
    /// Chooses by weight among definitions of the same name and parameters; null after an error.
    const InstDefinition* choose(const InstDefinition& definition, const std::vector<double>& arguments,
                                 std::uint64_t key, std::uint32_t variant);

    const InstModule& module_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    InstIndex index_;
    InstChance chance_;
    std::uint64_t seed_;
    Environment lets_;
    Graph graph_;
    std::map<std::string, Span, std::less<>> uses_;
    std::size_t parts_ = 0;                                    ///< of used models, that were asked for
    std::map<std::string, ModelFamily, std::less<>> families_; ///< of the used models with inner parameters
    std::unordered_map<std::string, ObjectId> by_name_;
    std::unordered_map<std::string, ObjectId> variants_; ///< of random objects, by name and variant
    std::unordered_map<std::string, MaterialId> materials_;
    HueTable hues_;
    InkTable inks_;

    std::vector<Reached> reached_;
    std::size_t current_ = 0;           ///< the index of the object being lowered
    std::uint64_t place_ = 0;           ///< places of it that have random numbers so far
    ObjectEnvironment object_, choice_; ///< of the object being lowered, and of one that may be chosen
    const Environment& environment_ = object_.values;
    ChanceDraws draws_; ///< of the copy of a group being lowered
    std::unordered_map<const InstTest*, bool>
        tests_;           ///< of the object being lowered, as far as they were asked
    Diagnostics scratch_; ///< its errors
    std::set<const InstReference*> unknown_;
    std::unordered_map<const InstReference*, Primitive> meshes_;
    std::unordered_map<std::string, ObjectId> shapes_; ///< primitives of numbers, by their references
    PrimitiveObjects primitives_{graph_};
    std::unordered_map<std::string, unsigned> repeat_numbers_; ///< counts so far, by object name
    std::set<const InstDefinition*> failed_;
    std::set<const Expression*> rounded_; ///< hues that have a note
    std::unordered_map<const InstDefinition*, std::size_t> tuples_;
    std::size_t instance_count_ = 0;
    std::size_t work_ = 0;
    std::size_t suggestion_work_ = 0;
    bool stopped_ = false;
};

} // namespace graftal
