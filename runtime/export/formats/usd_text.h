#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace graftal {

/// The name of a file as USD writes it: one with an @ stands between three of them.
inline std::string usd_asset(std::string_view name) {
    const std::string_view mark = name.find('@') == std::string_view::npos ? "@" : "@@@";
    return fmt::format("{0}{1}{0}", mark, name);
}

} // namespace graftal
