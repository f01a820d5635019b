#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace graftal::fuzz {

/// The words of a command line, as a shell has them without quotes: parted by white space, a '\1' in a word
/// for a blank.
inline std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (c == ' ' || c == '\n' || c == '\t')
            words.emplace_back();
        else if (c != '\0') // ends a word for the kernel
            words.back() += c == '\1' ? ' ' : c;
    }
    std::erase(words, std::string());
    return words;
}

/// As main() has them.
inline std::vector<const char*> arguments_of(const std::vector<std::string>& words) {
    std::vector<const char*> arguments{"graftal"};
    for (const std::string& word : words)
        arguments.push_back(word.c_str());
    return arguments;
}

} // namespace graftal::fuzz
