#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/inst/inst_ast.h"
#include "compiler/syntax/token_stream.h"

// Lines that stand both in the groups of an object and in the blocks of its repeats.

namespace graftal {

/// The keywords of the lines of an object; those of scatters come last.
const std::vector<std::string>& body_keywords();
bool is_body_keyword(const Token& token);

/// True at `repeat 12 {` or `12 * {`; else an object may have the name `repeat`.
bool at_repeat(const TokenStream& stream);

/// Requires at_repeat(). The count and the block of what each copy adds; errors are reported and give
/// nothing.
std::optional<InstRepeat> parse_inst_repeat(TokenStream& stream);

/// `tint: r, g, b, a`, or a range of them; errors are reported and give nothing. Requires that it is at
/// `tint`.
std::optional<InstTint> parse_inst_tint(TokenStream& stream);

/// Reports that a range of tints stands outside of a scatter; false.
bool refuse_tint_range(Span span, Diagnostics& diagnostics);

/// True at `hue: 15` or `hue 15`; else an object may have that name.
bool at_hue(const TokenStream& stream);

/// Requires at_hue(). False after an error; a second one is reported, and does not count.
bool parse_hue_value(TokenStream& stream, std::optional<Expression>& hue);

} // namespace graftal
