#pragma once

#include <string>
#include <string_view>

namespace graftal {

/// "write 'cube'" for `box`, a word for a shape; "" for words that are none. Capitals do not count.
std::string shape_word_hint(std::string_view word);
/// "write 'translate: 1, 0, 0'" for `move`, a word for a line of an instance or a map; likewise.
std::string line_word_hint(std::string_view word);

} // namespace graftal
