#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/lower/object_pool.h"
#include "compiler/lsys/compose/part_table.h"
#include "compiler/lsys/compose/sizes.h"
#include "compiler/lsys/compose/variants.h"
#include "compiler/lsys/derive/folded_word.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/lsys/turtle/state.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/lsys/turtle/witness.h"

namespace graftal {

/// Turned in the plane of the turtle so that it heads for `exit`, where that lies in the plane; else not
/// turned.
Mat3 chord_frame(Vec3 exit);

struct LsysLimits {
    std::size_t max_parts = 1'000'000; ///< more are an error
    /// Directions that `$` and tropism look at are taken for equal within this angle, in radians, when a part
    /// is looked up; it is then placed exactly. The displacement is bounded in TurtlePart::error.
    double snap_angle = 0;
    /// With this many parts of which few serve twice, composing gives up: drawing by modules is faster.
    std::size_t give_up_from = SIZE_MAX;
    /// With this many parts of which few serve twice, composing fails: there will be too many.
    std::size_t refuse_from = SIZE_MAX;
    /// With this many parts, composing gives up, whatever the number that serve twice.
    std::size_t stop_from = SIZE_MAX;
    /// Bytes of the parts and their objects. With more, composing gives up where `give_up_from` lets it; else
    /// they are an error.
    std::size_t max_bytes = std::size_t{1} << 30;
    /// Modules that differ in their size only are composed once, and placed as large as they are; null: not.
    const LsysSizes* sizes = nullptr;
    /// With `sizes`, widths and units relative to a part's size are taken for equal where their logarithms
    /// differ by less than this; so are parameters that reach nothing but widths. TurtlePart::error bounds
    /// the displacement.
    double size_step = 0;
    bool steps_unit = true; ///< or the width alone
};

/// Compiles a derivation without deriving it (Hart 1992, section 4, made automatic). The outcome of a module
/// depends on the module, the steps that are left, and the incoming state of the turtle that its subtree
/// reads. So each such *part* is composed once, out of the parts of its successor, and costs are O(parts),
/// not O(length of the word). Where productions are random, the variant of the part (variants.h) counts as a
/// part of that state.
class LsysComposer {
  public:
    /// All references must outlive this.
    LsysComposer(LsysRewriter& rewriter, TurtleContext& turtle, ObjectPool& pool, const ModelPlacer& models,
                 Variants variants, const LsysLimits& limits);

    /// The part that the axiom becomes after `steps` steps; nothing after an error in the turtle's
    /// diagnostics. When it is drawn, a share of the next step, of [0, 1), has passed. Always the same steps
    /// and share.
    std::optional<TurtlePart> compose(unsigned steps, const TurtleState& start, double share = 0);

    /// The part of a word that is derived already: its pieces are drawn once, and shared where they are
    /// alike. Always the same word, which must outlive this.
    std::optional<TurtlePart> compose_word(const FoldedWord& word, unsigned steps, const TurtleState& start,
                                           double share = 0);

    /// From now on the witness, which must outlive this, hears of the whole word: each part is composed again
    /// wherever it stands, by the choices of chance that it is composed by once. O(modules of the word); with
    /// a witness that sums up, O(parts).
    void tell(WordWitness& witness) {
        witness_ = &witness;
        sums_ = witness.sums();
    }

    std::size_t part_count() const { return parts_.size(); }
    /// Whether most of them were placed once only.
    bool few_serve_twice() const { return served_ < parts_.size() + parts_.size() / 8; }
    /// Whether compose() gave nothing without an error, as it may by the limits.
    bool gave_up() const { return gave_up_; }
    /// Whether it was given up because of them.
    bool too_many_parts() const { return too_many_parts_; }

    /// The first part that made an object.
    struct Origin {
        ModuleId module = 0;
        unsigned steps = 0; ///< steps left
    };
    const std::unordered_map<ObjectId, Origin>& origins() const { return origins_; }

  private:
    /// 0: being drawn; 2k: before a step, of k that are left; 2k + 1: being decomposed before that.
    using Stage = PartTable::Stage;

    /// A module as it is looked up, with the state that it finds, and how its part is placed.
    struct Lookup {
        ModuleId module = 0;
        TurtleState state;
        Placing placing;
    };

    /// The alternative that is drawn in place of a module.
    struct Unfolded {
        const Alternative* by = nullptr; ///< null: drawn as it is
        RuleDraw draw;                   ///< the alternative's random numbers
        RuleKind kind = RuleKind::produce;
        Moment moment;       ///< of the production
        Stage stage = 0;     ///< of the successor
        bool random = false; ///< the variant decided
        bool aged = false;   ///< the birth decided how it is drawn
    };

    /// A module's string under way.
    struct Task {
        ModuleId module = 0; ///< or a piece of the word
        Stage stage = 0;     ///< of the module
        TurtleState start;
        const LsysRule* rule = nullptr; ///< source of the string; null: the axiom, or a word
        ModuleString drawn;             ///< the string, if it has random numbers
        std::span<const ModuleId> string;
        Stage string_stage = 0;
        std::uint32_t birth = 0; ///< of the modules of the string, where they do not say
        bool interprets = false; ///< the string is drawn, but not part of the word
        Span span;               ///< of the production
        Turtle turtle;
        std::size_t at = 0;    ///< next in the string
        unsigned repeated = 0; ///< parts around this one at the same stage
        Placing placing;       ///< with a witness, in the task before
        PartFrame frame;
    };

    Stage stage_before(unsigned steps) const;
    std::uint32_t birth_at(Stage stage) const { return steps_ - stage / 2; }
    std::uint32_t chance_stage(Stage stage, bool drawing) const;
    std::uint32_t chance_module(ModuleId module) const;
    std::uint32_t birth_of(ModuleId module, const Task& task) const;
    bool unfold(ModuleId module, Stage stage, std::uint32_t birth, std::uint32_t variant, Unfolded& result);
    bool rewrite(ModuleId module, Stage stage, std::uint32_t birth, std::uint32_t variant, Unfolded& result);
    bool refuse_to_wait(SymbolId symbol);
    bool choose(RuleKind kind, ModuleId module, Stage stage, std::uint32_t birth, std::uint32_t variant,
                Unfolded& result);
    std::optional<TurtlePart> run_from(Task first);
    bool run_tasks();
    bool advance(Task& task);
    bool draw(Task& task, ModuleId module, bool absolute, std::uint32_t birth);
    bool carry_out(Task& task, ModuleId module, bool absolute);
    std::vector<double> written_parameters(const Task& task, ModuleId module, bool absolute) const;
    bool begins_interpretation(const Task& task, ModuleId module, bool absolute, std::uint32_t birth);
    ModuleId in_units(ModuleId module, double unit);
    bool resize(Lookup& found, const Task& task, bool absolute);
    double stepped(double size, double& error);
    std::vector<double> parameters_of(ModuleId module) const;
    bool has_room(Span span);
    const TurtlePart* known_part(ModuleId module, Stage stage, const TurtleState& state) const;
    bool append(Task& parent, const TurtlePart& part, const Placing& placing, bool interprets);
    bool start_task(const Lookup& found, Stage stage, const Unfolded& unfolded);
    PartFrame frame_of_child(const Placing& placing) const;
    std::optional<Instance> line_for(const TurtlePart& part, const Task& task);
    bool draw_piece(Task& task, ModuleId piece);
    void clean_exit(TurtlePart& part);
    void count_work(const TurtlePart& part);
    std::size_t new_polygon_work();
    void complete_piece();
    bool complete_task();
    TurtleState state_of(const Turtle& turtle, double& snap);
    Vec3 representative(Vec3 point);
    std::shared_ptr<const TurtleFrame> representative(const TurtleFrame& exact, double& snap);
    std::string name_of_part(const Task& task) const;

    LsysRewriter& rewriter_;
    TurtleContext& context_;
    ObjectPool& pool_;
    const ModelPlacer& models_;
    Variants variants_;
    std::size_t max_parts_;
    std::size_t give_up_from_;
    std::size_t refuse_from_;
    std::size_t stop_from_;
    std::size_t max_bytes_;
    std::size_t served_ = 0; ///< how often a part was placed that had steps left
    bool gave_up_ = false;
    bool snaps_;
    const LsysSizes* sizes_;
    double size_step_;
    bool steps_unit_;
    bool too_many_parts_ = false;
    std::size_t skin_triangles_ = 0; ///< whose work is counted
    std::size_t polygon_work_ = 0;   ///< that is counted
    const FoldedWord* word_ = nullptr;
    WordWitness* witness_ = nullptr;
    bool sums_ = false; ///< so does the witness
    std::vector<Task> tasks_;
    PartTable parts_;
    std::unordered_map<ObjectId, Origin> origins_;
    DirectionTable directions_;
    RotationTable rotations_; ///< of exits
    NumberTable sizes_known_; ///< widths and units
    // Control points; never snapped.
    NumberTable lengths_;
    DirectionTable ways_;
    std::vector<bool> rewritten_; ///< by symbol
    bool uses_directions_;
    bool decomposes_;
    bool is_timed_;           ///< the drawing depends on the time
    std::uint32_t steps_ = 0; ///< of the derivation
    double share_ = 0;        ///< of the next, when it is drawn
    /// Modules with productions that read the time, and so may fit later if not now: by their stage, the one
    /// at which one fits; 0 if none ever does.
    std::unordered_map<std::uint64_t, Stage> fits_at_;
    std::uint64_t waits_ = 0; ///< how often it was tried
};

} // namespace graftal
