#pragma once

#include <string_view>

namespace graftal {

/// Whether `.inst` gives the word a meaning, so that an imported object, parameter or constant needs another
/// name.
bool is_own_word(std::string_view word);

} // namespace graftal
