#include "compiler/support/shell_words.h"

#include <string_view>

namespace graftal {

std::string shell_quoted(const std::vector<std::string>& words) {
    constexpr std::string_view harmless =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=+.,/:@%^";
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += ' ';
        if (!word.empty() && word.find_first_not_of(harmless) == std::string::npos) {
            out += word;
            continue;
        }
        out += '\'';
        for (const char c : word)
            out += c == '\'' ? std::string("'\\''") : std::string(1, c);
        out += '\'';
    }
    return out;
}

} // namespace graftal
