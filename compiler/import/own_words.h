#pragma once

#include <set>
#include <string>
#include <string_view>

namespace graftal {

/// Whether `.inst` gives the word a meaning, so that an imported object, parameter or constant needs another
/// name.
bool is_own_word(std::string_view word);

/// The plain name for `wanted`, with `suffix` if it is an own word.
std::string own_name(std::string_view wanted, std::string_view suffix);

/// Such a name, with a number if it is among `taken`, which it then is.
std::string free_own_name(std::string_view wanted, std::string_view suffix, std::set<std::string>& taken);

} // namespace graftal
