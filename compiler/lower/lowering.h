#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/language.h"
#include "compiler/lower/lower_options.h"
#include "compiler/lower/parsed_files.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"

namespace graftal {

/// An object of a used `.inst` file that another file asks for, `m.bough(2)` as `bough` with 2.
struct PartCall {
    std::string name;
    std::vector<double> arguments;

    auto operator<=>(const PartCall&) const = default;
};

/// A file that is being lowered: the root model, or one on the chain of `use` statements below it.
struct LoadingFile {
    std::string path;                  ///< normalised, so that a cycle is noticed
    Span use_span;                     ///< of the `use` that asked for it; unknown for the root
    Environment inner = {};            ///< values of its inner parameters, where they are given
    std::optional<PartCall> part = {}; ///< the part asked for, if not the whole picture
    std::size_t failures_before = 0;   ///< Lowering::failures() before it was parsed
};

/// A used file, with the values that it has been lowered for.
struct LoweredKey {
    std::string path;
    Environment inner;
    std::optional<PartCall> part;

    auto operator<=>(const LoweredKey&) const = default;
};

/// State that the files and front-ends of one model share while it is lowered.
struct Lowering {
    SourceMap& sources;
    Diagnostics& diagnostics;
    const LowerOptions& options;
    const LowerHelp& help;
    WorkMeter& meter;                    ///< of modules, parts and objects
    std::span<const Language> languages; ///< languages of models
    ParsedFiles& parsed;
    std::vector<LoadingFile> loading = {}; ///< from the root model to the file being lowered
    /// Models already lowered; null after errors. A model used twice is read and reported once.
    std::map<LoweredKey, std::shared_ptr<const Graph>> lowered = {};
    bool part_missing = false; ///< the part that was asked for last does not exist; nothing was said
    std::map<std::string, FileId> files = {}; ///< used files that were read, by path
    /// The texts of used models in our languages, by path; nothing after an error.
    std::map<std::string, std::optional<FileId>> own_texts = {};
    std::map<std::string, std::optional<Primitive>> meshes = {}; ///< by path; nothing after an error
    std::size_t use_count = 0;                                   ///< `use` statements so far, in all files
    std::size_t known_failures = 0; ///< models that were asked for and had failed before
    LowerNotes notes = {};          ///< of the root model, apart from meshes
    std::set<std::pair<FileId, std::uint32_t>> noted_places = {}; ///< where the parameters of the notes begin

    /// `--set` speaks to the root model only.
    bool at_root_model() const { return loading.size() <= 1; }
    /// Grows whenever a part of a model fails, also where nothing is said since it was said before.
    std::size_t failures() const { return diagnostics.error_count() + known_failures; }
    /// Whether the file that is being lowered is at fault: errors alone are those of other files too.
    bool file_failed() const { return failures() > loading.back().failures_before; }
};

/// The file that a model names, looked up beside the model's own; nothing after an error, if there is none,
/// or it is no regular file: others (pipes, devices) could keep a compilation waiting for ever.
std::optional<std::string> find_beside(Span name_span, std::string_view path, Lowering& lowering);

/// The mesh in a file that a model names (find_beside), read once. Nothing after an error.
std::optional<Primitive> load_mesh(Span name_span, std::string_view path, Lowering& lowering);

/// The file of a `use`, looked up beside the file that holds the span, and read if it is not known yet; once
/// for each `use`, of which there may be a thousand. Nothing after an error.
std::optional<FileId> read_model(const UseStatement& use, Lowering& lowering);

/// Loads `use NAME = "path"`: looked up beside the file that holds `use_span`, lowered, and appended to
/// `into`: objects as `NAME.object`, primitives shared, materials shared where equal, else renamed to
/// `NAME.material`; its scene settings do not count. Gives the id of its root, or nothing after an error.
/// Requires that read_model() has read it, that `into` has its own materials already, and no object yet whose
/// name begins with `NAME.`.
std::optional<ObjectId> import_model(Graph& into, const UseStatement& use, Lowering& lowering);

/// Imports one member of a family: its inner parameters have these values. Its objects are named
/// `NAME.k1.object`, with another number for each member. Its materials are named `NAME.material`, unless an
/// equal one is there already. `into` may have objects by any names.
std::optional<ObjectId> import_member(Graph& into, const UseStatement& use, const Environment& inner,
                                      Lowering& lowering);

/// The object that a part of a used model stands for, with what it contains: named `NAME.object`, and what
/// `known`, objects of `into` by name, has under these names already is taken, so all parts share it. A part
/// that does not exist is an error without a message, and sets Lowering::part_missing. Other languages have
/// no parts. Requires that import_model() was given this `use`.
std::optional<ObjectId> import_part(Graph& into, const std::unordered_map<std::string, ObjectId>& known,
                                    const UseStatement& use, const PartCall& part, Lowering& lowering);

/// The most instances that one model may have, as a multiple of LowerOptions::max_objects.
inline constexpr std::size_t max_instances_per_object = 4;

/// Whether colours that make a graph of this size are to be left out: a note at `place` says so
/// (LowerOptions::may_leave_out_colours). `work_left`: before they were made, in seconds.
bool leaves_out_colours(std::size_t objects, std::size_t instances, double work_left, Span place,
                        Lowering& lowering);

/// Reports and gives false if a graph with these counts is larger than the options allow.
bool within_limits(std::size_t objects, std::size_t instances, Span span, Lowering& lowering);

} // namespace graftal
