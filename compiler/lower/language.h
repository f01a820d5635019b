#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/foreign_words.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

struct Lowering;

/// Where a model may state its inner parameters.
struct InnerStatements {
    std::vector<SceneStatement> file;  ///< statements of the file
    std::vector<SceneStatement> block; ///< statements of its main block, where the language has blocks
};

/// A model file after parsing, in its own language. Its texts are views of the source.
class ModelTree {
  public:
    virtual ~ModelTree() = default;

    virtual InnerStatements inner_statements() const = 0;
    /// Nothing if it has added to Lowering::failures(), or if the model is an orbit (LowerNotes::orbit); else
    /// a graph that verify() accepts. Requires that the file is the last of Lowering::loading.
    virtual std::optional<Graph> lower(Lowering& lowering) const = 0;
};

/// The tree of a file that `parse` has read, from the functions that know it.
template<auto parse, auto inner, auto lowered>
std::unique_ptr<const ModelTree> parse_tree(const SourceMap& sources, FileId file,
                                            const ForeignWords& foreign, Diagnostics& diagnostics) {
    using File = decltype(parse(sources, file, diagnostics, foreign));
    struct Tree final : ModelTree {
        explicit Tree(File read) : file(std::move(read)) {}
        InnerStatements inner_statements() const override { return inner(file); }
        std::optional<Graph> lower(Lowering& lowering) const override { return lowered(file, lowering); }
        File file;
    };
    return std::make_unique<Tree>(parse(sources, file, diagnostics, foreign));
}

/// One language: a row of the table in languages/languages.h.
struct Language {
    std::string_view extension; ///< of the names of its files, without the dot
    /// The words that begin its statements at the top of a file, apart from those of scene statements.
    std::span<const std::string_view> keywords;
    /// The words that begin statements inside its blocks. A file that begins with one of them is a model with
    /// a fault.
    std::vector<std::string_view> inner_keywords;
    bool has_time = false; ///< a model can be drawn between two of its steps
    /// Reports what is wrong with the text; the tree then holds what could be read.
    std::unique_ptr<const ModelTree> (*parse)(const SourceMap& sources, FileId file,
                                              const ForeignWords& foreign, Diagnostics& diagnostics);
};

/// A file in a language: its parse() with the words of the others.
std::unique_ptr<const ModelTree> parse_model(const Language& language, FileId file, const SourceMap& sources,
                                             std::span<const Language> languages, Diagnostics& diagnostics);

/// The language of files with this ending, ".rifs" for one; null: none.
const Language* language_with_ending(std::string_view ending, std::span<const Language> languages);

/// The language of a file by its name; null where the name has none of the extensions. The language of
/// standard input is the one that alone begins a statement with the first such word outside of braces, else
/// the last of the table.
const Language* language_of(FileId file, const SourceMap& sources, std::span<const Language> languages);

/// ".lsys, .rifs or .inst"
std::string extensions(std::span<const Language> languages);

/// The name that standard input has in a SourceMap.
inline constexpr std::string_view standard_input = "<stdin>";

/// Lowers a file in its own language. `asked_for` is where errors about the choice belong.
std::optional<Graph> lower_file(FileId file, Span asked_for, Lowering& lowering);

} // namespace graftal
