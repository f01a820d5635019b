#include "compiler/povray/emit/names.h"

#include <algorithm>

namespace graftal {

namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

} // namespace

std::string harmless(std::string_view text) {
    std::string safe(text.substr(0, 60));
    for (char& c : safe)
        if (!is_letter(c) && !is_digit(c) && std::string_view("_.()+-").find(c) == std::string_view::npos)
            c = '_';
    return safe;
}

std::string identifier_part(std::string_view text) {
    std::string safe(text.substr(0, 24));
    for (char& c : safe)
        if (!is_letter(c) && !is_digit(c)) c = '_';
    // `tip(3)` reads better as tip_3 than as tip_3_.
    while (!safe.empty() && safe.back() == '_')
        safe.pop_back();
    return safe;
}

bool is_model_identifier(std::string_view text) {
    return !text.empty() && text[0] >= 'A' && text[0] <= 'Z' && identifier_part(text) == text;
}

std::string model_identifier(std::string_view name) {
    name = name.substr(0, name.rfind('.'));
    std::string safe = identifier_part(name);
    if (safe.empty() || !is_letter(safe[0])) return "Model_" + safe;
    if (safe[0] >= 'a') safe[0] = static_cast<char>(safe[0] - 'a' + 'A');
    return safe;
}

std::string UniqueNames::next(std::string_view wish) {
    const std::string base = prefix_ + identifier_part(wish);
    unsigned& tried = used_[base];
    if (tried++ == 0) return base;
    while (true) {
        const std::string name = base + "_" + std::to_string(tried);
        if (used_.try_emplace(name, 1).second) return name;
        ++used_[base];
    }
}

} // namespace graftal
