#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/inst/parse/ast.h"
#include "compiler/syntax/token_stream.h"

// Lines that the groups of an object and the blocks of its repeats share.

namespace graftal {

/// The keywords of the lines of an object; those of scatters come last.
const std::vector<std::string>& body_keywords();
bool is_body_keyword(const Token& token);

/// True at `repeat 12 {` or `12 * {`; else an object may have the name `repeat`.
bool at_repeat(const TokenStream& stream);

/// Requires at_repeat(). Parses the count and the block of lines that each copy adds. Nothing after an error,
/// which it reports.
std::optional<InstRepeat> parse_inst_repeat(TokenStream& stream);

/// Requires that the stream is at `tint`. Parses `tint: r, g, b, a`, or a range of them. Nothing after an
/// error, which it reports.
std::optional<InstTint> parse_inst_tint(TokenStream& stream);

/// Reports a range of tints outside of a scatter; false.
bool refuse_tint_range(Span span, Diagnostics& diagnostics);

/// True at `hue: 15` or `hue 15`; else an object may have that name.
bool at_hue(const TokenStream& stream);

/// Requires at_hue(). False after an error. It reports a second hue, and ignores it.
bool parse_hue_value(TokenStream& stream, std::optional<Expression>& hue);

/// True at `ink:` or `ink {`; else an object may have that name.
bool at_ink(const TokenStream& stream);

/// Requires at_ink(). Adds the steps of the line. False after an error, which it reports.
bool parse_inst_ink(TokenStream& stream, std::vector<InstInkStep>& steps);

} // namespace graftal
