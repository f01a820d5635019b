#pragma once

#include <string>

#include "compiler/syntax/lexer.h"

namespace graftal {

/// "write 0.78*s" between the two tokens of `0.78s`, where an expression ends too early; else "".
std::string lost_product_hint(const Token& before, const Token& token);

} // namespace graftal
