#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/support/affine.h"
#include "compiler/support/tint.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/transform.h"

namespace graftal {

/// Evaluates three expressions.
std::optional<Vec3> lower_vector(const std::vector<Expression>& values, const Environment& environment,
                                 Diagnostics& diagnostics);

/// Evaluates a colour (syntax/expression_parser.h) as linear RGB; components outside [0,1] are errors.
std::optional<Rgb> lower_color(const std::vector<Expression>& values, const Environment& environment,
                               Diagnostics& diagnostics);

/// The brightest colour of a light: 1 is full white on a white surface that faces it.
inline constexpr double brightest_light = 1e6;
std::optional<Rgb> lower_light_color(const std::vector<Expression>& values, const Environment& environment,
                                     Diagnostics& diagnostics);

/// Evaluates colour and alpha; values outside [0,1] are errors. `draws`: for `random` and `normal`.
std::optional<Tint> lower_tint(const std::vector<Expression>& values, const Environment& environment,
                               Diagnostics& diagnostics, const ChanceDraws& draws = {});

/// The size in pixels that `below:` gives; nothing, after an error, unless it lies between 0 and 10^6.
std::optional<double> lower_size_px(const Expression& size_px, const Environment& environment,
                                    Diagnostics& diagnostics, const ChanceDraws& draws = {});

/// The primitive of a kind that these numbers make; nothing, after an error, where they make none. Requires
/// takes_count(kind, numbers.size()).
std::optional<Primitive> lower_primitive(PrimitiveKind kind, std::span<const double> numbers, Span place,
                                         Diagnostics& diagnostics);

/// The kind of a primitive whose name takes numbers in parentheses: `frustum`.
std::optional<PrimitiveKind> kind_of_numbers(std::string_view name);
/// Whether models may not give this name to what they define: it is a primitive's, of the first eight kinds.
/// A model's own name hides that of a kind with shapes, so that a new kind breaks no model.
bool is_reserved_name(std::string_view name);
/// Whether this many numbers may make a primitive of a kind of numbers.
bool takes_count(PrimitiveKind kind, std::size_t count);
/// The numbers of arguments that the kind takes: "1 argument".
std::string counts_taken(PrimitiveKind kind);

/// The map of one line. Errors: singular maps (but not of `projection`, which must only not vanish), zero
/// axes, points that lie on one line or in one plane, numbers that are not finite. `matrix` and `projection`
/// are taken to the last bit.
///
/// Two factors of a scale are those of x and y; z gets their geometric mean, so that flat figures keep a
/// regular map that is a similarity where the flat one was.
std::optional<Affine> lower_transform(const TransformLine& line, const Environment& environment,
                                      Diagnostics& diagnostics, const ChanceDraws& draws = {});

/// The product of the lines, the first applied first; identity for none. A single line is taken to the last
/// bit. Besides the errors of the lines: products that are singular (unless a `projection` takes part),
/// vanish or overflow.
std::optional<Affine> lower_transforms(const std::vector<TransformLine>& lines,
                                       const Environment& environment, Diagnostics& diagnostics,
                                       const ChanceDraws& draws = {});

} // namespace graftal
