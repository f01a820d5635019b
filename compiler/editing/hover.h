#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compiler/editing/document.h"
#include "compiler/session/values.h"

namespace graftal {

struct Hover {
    Span span;        ///< the word
    std::string text; ///< Markdown
};

/// The meaning of the word at a place: of a name what the text says of it, of objects, maps and blocks their
/// size too, as `model` has them (null: unknown); of others the line of the one table (words.h). Nothing
/// where no word is. Requires offset <= size of the text. O(text), and of small models O(graph).
std::optional<Hover> hover(const Document& document, std::uint32_t offset,
                           const AnalysedModel* model = nullptr);

/// A place in a file.
struct FilePlace {
    std::string file; ///< as the document's own name, or as a `use` means it
    Span span;        ///< of the document; of another file its beginning
};

/// The place where the text says what the name at a place is: its first definition; of a file in quotes the
/// file. Nothing for words, and for names that nothing here defines.
std::optional<FilePlace> definition(const Document& document, std::uint32_t offset);

} // namespace graftal
