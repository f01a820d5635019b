#include "compiler/syntax/foreign_words.h"

#include <fmt/format.h>

namespace graftal {

std::string foreign_word_hint(const ForeignWords& words, std::string_view word) {
    const auto found = words.find(word);
    return found == words.end() ? "" : fmt::format("the name of such a model ends in .{}", found->second);
}

} // namespace graftal
