#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lpy/system.h"
#include "compiler/support/srgb.h"

namespace graftal {

namespace {

constexpr std::size_t most_colours = 256;

/// The numbers of a text behind each other, up to `count`; names between them do not count.
std::vector<double> material_numbers(std::string_view text, std::size_t count) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < text.size() && numbers.size() < count;) {
        const bool begins = std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.';
        const bool inside =
            i > 0 && (std::isalnum(static_cast<unsigned char>(text[i - 1])) || text[i - 1] == '_');
        const LeadingNumber number = begins && !inside ? leading_number(text.substr(i, 40)) : LeadingNumber();
        if (number.length > 0 && std::isfinite(number.value)) numbers.push_back(number.value);
        i += std::max<std::size_t>(number.length, 1);
    }
    return numbers;
}

/// Colour of `Material(...)`: its ambient one from 0 to 255, times its diffuse part.
std::optional<Rgb> material_of(std::string_view text) {
    const std::size_t open = text.find("Material(");
    if (open == std::string_view::npos) return std::nullopt;
    text = text.substr(open + 9);
    text = text.substr(std::min(text.find_first_of(",)"), text.size())); // behind its name
    const std::vector<double> numbers = material_numbers(text, 4);
    if (numbers.size() < 3) return std::nullopt;
    const bool plain =
        text.find("diffuse") == std::string_view::npos && text.find("Color3") == std::string_view::npos;
    const double diffuse = numbers.size() > 3 && !plain ? numbers[3] : 1;
    const auto part = [&](double ambient) { return std::clamp(ambient * diffuse / 255, 0.0, 1.0); };
    return linear_from_srgb(Rgb{part(numbers[0]), part(numbers[1]), part(numbers[2])});
}

} // namespace

std::vector<Rgb> lpy_colours(std::string_view text) {
    constexpr double usual[][3] = {{160, 160, 160}, {195, 135, 45}, {90, 180, 30}, {180, 0, 0},
                                   {180, 180, 45},  {0, 0, 180},    {180, 0, 180}};
    std::vector<Rgb> colours;
    for (const auto& [r, g, b] : usual)
        colours.push_back(linear_from_srgb(Rgb{r / 255, g / 255, b / 255}));
    std::optional<Rgb> last; // of `Color_1 = Material(...)`, the line before it is set
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::optional<Rgb> material = material_of(line.text);
        const std::size_t set = line.text.find("setMaterial(");
        if (set == std::string_view::npos) {
            if (material) last = material;
            continue;
        }
        const std::vector<double> number = material_numbers(line.text.substr(set + 12), 1);
        const std::optional<Rgb> known = material ? material : last;
        if (!known || number.empty() || number[0] >= most_colours) continue;
        const auto place = static_cast<std::size_t>(number[0]);
        while (colours.size() <= place)
            colours.push_back(colours[0]);
        colours[place] = *known;
    }
    return colours;
}

} // namespace graftal
