#pragma once

#include <optional>
#include <string_view>

namespace graftal {

/// The value of a condition of the C preprocessor, whose macros are written out; names that are left are 0.
/// Nothing if it is none.
std::optional<double> cpfg_condition(std::string_view text);

} // namespace graftal
