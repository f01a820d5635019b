#include "runtime/graftal/library_words.h"

#include <algorithm>
#include <utility>

namespace graftal::v1 {

namespace {

constexpr std::pair<std::string_view, std::string_view> library_names[] = {
    {"--antialias", "antialias"},
    {"--quality", "quality"},
    {"--seed", "seed"},
    {"--size", "size"},
    {"--camera", "camera"},
    {"--engine", "engine"},
    {"--error", "error_px"},
    {"--instancing", "instancing"},
    {"--levels", "levels"},
    {"--limit", "most_bytes"},
    {"--memory", "memory"},
    {"--nodes", "nodes"},
    {"--part", "parts"},
    {"--root", "root"},
    {"--steps", "steps"},
    {"--work", "work"},
    {"--set", "set"},
    {"--zoom", "zoom"},
    {"--ground-area", "ground_area"},
    {"--irradiance", "irradiance"},
};

constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz-";

} // namespace

std::string in_library_words(std::string_view message) {
    std::string text;
    while (true) {
        const std::size_t at = std::min(message.find("--"), message.size());
        text += message.substr(0, at);
        message.remove_prefix(at);
        if (message.empty()) return text;
        const std::string_view option = message.substr(0, message.find_first_not_of(letters));
        message.remove_prefix(option.size());
        const auto* const known =
            std::ranges::find(library_names, option, &std::pair<std::string_view, std::string_view>::first);
        if (known == std::end(library_names)) {
            text += option;
            continue;
        }
        std::string_view value; // in "'--steps 5'"
        if (text.ends_with('\'') && message.starts_with(' ')) {
            value = message.substr(1, message.find('\'') - 1);
            message.remove_prefix(1 + value.size());
        }
        text += known->second;
        text += '(';
        text += value;
        text += ')';
    }
}

} // namespace graftal::v1
