#pragma once

#include <cstddef>
#include <string>

namespace graftal {

/// "a, b or c" of a range, by the words that `word_of` gives for its elements; "" of an empty one.
template<typename Range, typename WordOf> std::string alternatives(const Range& range, WordOf word_of) {
    std::string text;
    for (std::size_t i = 0; i < range.size(); ++i) {
        if (i > 0) text += i + 1 < range.size() ? ", " : " or ";
        text += word_of(range[i]);
    }
    return text;
}

} // namespace graftal
