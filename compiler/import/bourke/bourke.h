#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"

namespace graftal {

enum class BourkeLineKind {
    remark,
    axiom,
    rule,      ///< `F -> F+F`
    parameter, ///< `angle = 90`
};

enum class BourkeParameter {
    angle,
    angle_increment,
    length,
    length_factor,
    width,
    width_increment,
    steps,
    unknown,
};

struct BourkeLine {
    BourkeLineKind kind = BourkeLineKind::remark;
    std::string_view value; ///< what stands behind the name; or the whole remark
    std::string_view name = {};
    BourkeParameter parameter = BourkeParameter::unknown;
    std::size_t begin = 0; ///< of the line's words in the text
    std::size_t value_begin = 0;
};

/// The lines of a text that say something.
std::vector<BourkeLine> bourke_lines(std::string_view text, std::size_t begin, std::size_t end);

/// Whether a text has an axiom and a rule in lines of their own, and no blocks in braces.
bool is_bourke(std::string_view text);

/// The translation of a model, which is of no use after an error.
std::optional<Translation> translate_bourke(const ForeignFile& file, const ForeignModel& model);

} // namespace graftal
