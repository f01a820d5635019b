#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace graftal {

/// `tip.hue7(2)` for `tip(2)` and the word "hue": a name that is not taken, and is then. `numbers`: the last
/// one by the name without its arguments.
std::string free_variant_name(const std::string& name, std::string_view word, std::set<std::string>& taken,
                              std::map<std::string, unsigned>& numbers);

} // namespace graftal
