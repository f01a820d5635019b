#include "compiler/syntax/foreign_words.h"

#include <fmt/format.h>

namespace graftal {

std::string foreign_word_hint(const ForeignWords& words, std::string_view word) {
    const auto found = words.find(word);
    return found == words.end()
               ? ""
               : fmt::format("name the file of such a model with the extension .{}", found->second);
}

} // namespace graftal
