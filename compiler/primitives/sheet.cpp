#include "compiler/primitives/sheet.h"

#include "compiler/primitives/solid.h"
#include "compiler/support/formula_words.h"

namespace graftal {

namespace formulas {
#include "compiler/primitives/sheet.glsl"
} // namespace formulas

std::optional<Sheet> sheet_of(const Primitive& primitive, const Mat3& linear, bool wide) {
    const PrimitiveTraits& traits = traits_of(primitive);
    if (!traits.bounded) return std::nullopt;
    Sheet sheet;
    sheet.thickness = formulas::sheet_thickness(linear[0], linear[1], linear[2], traits.box(primitive).size(),
                                                wide, sheet.normal);
    if (sheet.thickness < 0 || !encloses_volume(primitive)) return std::nullopt;
    return sheet;
}

} // namespace graftal
