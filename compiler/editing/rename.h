#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/text_edit.h"

namespace graftal {

struct Renaming {
    std::vector<TextEdit> edits;
    std::string refusal; ///< why the name cannot be given, as a sentence; "": it can
};

/// The name at a place that can be renamed; unknown where there is none.
Span renamable(const Document& document, std::uint32_t offset);

/// Gives another name to what the name at a place stands for, wherever this text says it: lets, parameters,
/// objects, models, materials, maps, blocks, modules with their rules, and the others that names_of() knows.
/// A long name of a module is declared. The text after the edits reads as before, with the name replaced:
/// what collides, is reserved, or would be read otherwise is refused. Other files are not looked at.
Renaming rename(const Document& document, std::uint32_t offset, std::string_view name);

} // namespace graftal
