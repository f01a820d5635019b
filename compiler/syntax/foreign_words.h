#pragma once

#include <map>
#include <string>
#include <string_view>

namespace graftal {

/// Words that begin statements in other languages only, each with the extension of their files, without the
/// dot. A parser that meets one gives a hint that the file may have the wrong name.
using ForeignWords = std::map<std::string_view, std::string_view>;

/// "the name of such a model ends in .lsys", or "" if the word is none of them.
std::string foreign_word_hint(const ForeignWords& words, std::string_view word);

} // namespace graftal
