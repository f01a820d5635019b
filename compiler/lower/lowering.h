#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower.h"

namespace graftal {

/// A file that is being lowered: the root model, or one on the chain of `use` statements below it.
struct LoadingFile {
    std::string path; ///< normalised, so that a cycle is noticed
    Span use_span;    ///< of the `use` that asked for it; unknown for the root
};

/// What lowering one model shares between its files and front-ends.
///
/// A front-end is a function `std::optional<Graph> lower_LANGUAGE(FileId file, Lowering& lowering)`: nothing
/// after an error in `diagnostics`, else a graph that verify() accepts.
struct Lowering {
    SourceMap& sources;
    Diagnostics& diagnostics;
    const LowerOptions& options;
    std::vector<LoadingFile> loading; ///< from the root model to the file being lowered
    /// Models already lowered, by path; null after errors. A model used twice is read and reported once.
    std::map<std::string, std::shared_ptr<const Graph>> lowered;
    std::size_t use_count = 0; ///< `use` statements so far, in all files
    std::optional<Derivation> derivation; ///< of the root model

    /// `--set` speaks to the root model only.
    bool at_root_model() const { return loading.size() <= 1; }
};

/// Lowers a file by the front-end that its name asks for. `asked_for` is where errors about the choice
/// belong.
std::optional<Graph> lower_file(FileId file, Span asked_for, Lowering& lowering);

/// The file that a model names, looked up beside the model's own; nothing after an error, if there is none, or
/// it is no regular file: others (pipes, devices) could keep a compilation waiting for ever.
std::optional<std::string> find_beside(Span name_span, std::string_view path, Lowering& lowering);

/// Loads `use NAME = "path"`: looked up beside the file that holds `use_span`, lowered, and appended to
/// `into`: objects as `NAME.object`, primitives shared, materials shared where equal, else renamed to
/// `NAME.material`; its scene settings do not count. Gives the id of its root, or nothing after an error.
/// Requires that `into` has its own materials already, and no object yet whose name begins with `NAME.`.
std::optional<ObjectId> import_model(Graph& into, Span use_span, std::string_view name, std::string_view path,
                                     Lowering& lowering);

/// The most instances that one model may have, as a multiple of LowerOptions::max_objects.
inline constexpr std::size_t max_instances_per_object = 4;

/// Reports and gives false if a graph with these counts is larger than the options allow.
bool within_limits(std::size_t objects, std::size_t instances, Span span, Lowering& lowering);

} // namespace graftal
