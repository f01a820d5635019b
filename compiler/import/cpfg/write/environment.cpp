#include "compiler/import/cpfg/write/environment.h"

#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

/// The lines `word: value` of a file. A word may come again.
using Settings = std::vector<std::pair<std::string, std::string>>;

Settings settings_in(std::string_view text) {
    Settings settings;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::size_t colon = line.text.find(':');
        if (colon == std::string_view::npos) continue;
        settings.emplace_back(trimmed(line.text.substr(0, colon)), trimmed(line.text.substr(colon + 1)));
    }
    return settings;
}

std::string setting(const Settings& settings, std::string_view word) {
    std::string value;
    for (const auto& [name, given] : settings)
        if (name == word) value = given;
    return value;
}

double number_in(const std::string& text, double otherwise) {
    const LeadingNumber number = leading_number(text);
    return number.length > 0 && std::isfinite(number.value) ? number.value : otherwise;
}

/// Whether a program measures in the plane of x and z, as it does unless it is told that it lives in space.
bool is_flat(const Settings& settings) {
    const std::string value = setting(settings, "3d case") + setting(settings, "3D case");
    return value != "on" && value != "yes";
}

/// Light sources of `chiba`: x y z intensity.
std::string sources_of(const Settings& settings) {
    std::string text;
    for (const auto& [name, value] : settings) {
        if (name != "source direction") continue;
        std::istringstream words(value);
        double x = 0, y = 0, z = 0, intensity = 0;
        if (words >> x >> y >> z >> intensity && intensity > 0)
            text += fmt::format(",  {}, {}, {}, {}", x, y, z, intensity);
    }
    return text;
}

} // namespace

std::string translated_cpfg_environment(const std::string& file_name, CpfgNames& names, Span span) {
    const ForeignFile& file = names.file();
    const auto text_of = [&](const std::string& name) -> std::string_view {
        const std::optional<FileId> known = file.read_beside(name);
        return known ? file.sources.text(*known) : std::string_view();
    };
    std::istringstream command(setting(settings_in(text_of(file_name)), "executable"));
    std::string program, specification;
    command >> program;
    for (std::string word; command >> word;)
        specification = word;
    const Settings settings = settings_in(text_of(specification));
    if (program == "honda81") {
        const double radius = number_in(setting(settings, "radius"), 0);
        if (radius > 0)
            return fmt::format("environment crowd {}{}", radius, is_flat(settings) ? ", 0, 1, 0" : "");
    } else if (program == "ecosystem" && setting(settings, "vigor") != "on") {
        return fmt::format("environment rivals{}", is_flat(settings) ? " 0, 1, 0" : "");
    } else if (program == "chiba" && setting(settings, "estimate intersection area") == "on" &&
               (!sources_of(settings).empty() ||
                number_in(setting(settings, "lower to upper ratio"), 0.7) == 0)) {
        return fmt::format("environment shade {}{}", number_in(setting(settings, "transmittance"), 0.6),
                           sources_of(settings));
    }
    names.error(span, program.empty() ? "the model's environment program is not known"
                                      : fmt::format("the environment program '{}' has no translation",
                                                    comment_text(program)));
    return "";
}

} // namespace graftal
