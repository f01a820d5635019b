#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace graftal {

/// A parameter of Houdini's L-system node, or a line that is none.
enum class HoudiniField {
    remark,
    premise,
    rule,
    generations,
    angle,
    angle_scale,
    step,
    step_scale,
    thickness,
    thickness_scale,
    gravity,
    value_b,
    value_c,
    value_d,
    ignore,
    seed,
    other ///< one that has no translation
};

struct HoudiniLine {
    HoudiniField field = HoudiniField::remark;
    std::string_view value; ///< or the whole remark
    std::size_t begin = 0;  ///< of the value in the text
    std::size_t line = 0;   ///< beginning of the line that names the parameter
};

/// The lines of a text that say something, with the marks of Markdown taken off.
std::vector<HoudiniLine> houdini_lines(std::string_view text, std::size_t begin, std::size_t end);

} // namespace graftal
