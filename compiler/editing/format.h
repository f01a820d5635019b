#pragma once

#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/text_edit.h"

namespace graftal {

/// Edits that lay a text out: blocks indented (by 4 in `.inst`, else by 2), a blank behind commas and colons
/// and before braces, no blanks at the ends of lines, single empty lines, a line end at the end. The edits
/// replace white space only: comments stay, and so do columns that somebody lined up. The text means the same
/// after them, and they lay out what is laid out already as it is. None for a text that the parser refuses.
std::vector<TextEdit> format(const Document& document);

} // namespace graftal
