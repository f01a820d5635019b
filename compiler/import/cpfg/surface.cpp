#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::size_t most_patches = 1000;
constexpr std::size_t patch_numbers = 48;

using Point = std::array<double, 3>;

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// All numbers of a line, whatever stands between them.
std::vector<double> numbers_in(std::string_view line) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < line.size() && numbers.size() < patch_numbers;) {
        const std::size_t begin = std::min(line.find_first_of("+-.0123456789", i), line.size());
        const std::size_t end = std::min(line.find_first_not_of("+-.0123456789eE", begin), line.size());
        const auto [number, length] =
            leading_number(line.substr(begin, std::min<std::size_t>(end - begin, 40)));
        if (length > 0 && std::isfinite(number)) numbers.push_back(number);
        i = end;
    }
    return numbers;
}

struct Surface {
    Point contact{0, 0, 0}, heading{0, 1, 0}, up{0, 0, 1};
    double size = 1; ///< the length that a scale of 1 makes 1
    std::vector<std::vector<double>> patches;
    std::vector<Span> places;
};

/// The first word of a line, without the colon after it.
std::string_view first_word(std::string_view words) {
    return words.substr(0, words.find_first_of(": \t"));
}

/// A patch begins with its name; the other words of the format are known.
bool begins_patch(std::string_view words) {
    constexpr std::array<std::string_view, 9> others = {"PRECISION", "CONTACT", "END", "HEADING", "UP",
                                                        "SIZE",      "TOP",     "AL",  "BL"};
    if (words.empty() || !std::isalpha(static_cast<unsigned char>(words[0])) || words.starts_with("L:"))
        return false;
    return std::ranges::find(others, first_word(words)) == others.end();
}

Surface read_surface(const ForeignFile& file) {
    Surface surface;
    for (const TextLine& line : lines_of(file.text(), 0, file.text().size())) {
        const std::string_view words = trimmed(line.text);
        const std::vector<double> numbers = numbers_in(words);
        const auto point = [&](Point& to) {
            if (numbers.size() == 3) to = {numbers[0], numbers[1], numbers[2]};
        };
        const std::string_view word = first_word(words);
        if (word == "CONTACT") point(surface.contact);
        if (word == "HEADING") point(surface.heading);
        if (word == "UP") point(surface.up);
        if (word == "SIZE" && !numbers.empty() && numbers[0] > 0) surface.size = numbers[0];
        if (begins_patch(words)) {
            if (surface.patches.size() == most_patches) {
                file.diagnostics.error(file.span(line.begin, line.begin + line.text.size()),
                                       fmt::format("a surface has at most {} patches", most_patches));
                return surface;
            }
            surface.patches.emplace_back();
            surface.places.push_back(file.span(line.begin, line.begin + line.text.size()));
        }
        const bool row = numbers.size() == 12 && !words.empty() &&
                         std::string_view("+-.0123456789").find(words[0]) != std::string_view::npos;
        if (row && !surface.patches.empty() && surface.patches.back().size() < patch_numbers)
            surface.patches.back().insert(surface.patches.back().end(), numbers.begin(), numbers.end());
    }
    return surface;
}

bool is_surface(std::string_view text) {
    return text.find("CONTACT POINT") != std::string_view::npos &&
           (text.find("patch") != std::string_view::npos || text.find("TOP COLOR") != std::string_view::npos);
}

Point of_unit_length(const Point& a) {
    const double length = std::sqrt(dot(a, a));
    return length > 0 ? Point{a[0] / length, a[1] / length, a[2] / length} : a;
}

/// The surface in the frame of a turtle that takes hold of it: x right, y ahead, z up. The left of cpfg's
/// turtle is heading x up, which of ours would be the right. So x is -left, y the heading, and z -up.
std::optional<Translation> translate_surface(const ForeignFile& file, const ForeignModel& model) {
    const Surface surface = read_surface(file);
    const Point heading = of_unit_length(surface.heading);
    const Point left = cross(heading, of_unit_length(surface.up));
    const Point up = cross(left, heading);
    Translation out{"inst", {}, {}};
    out.line(fmt::format("# {}: a surface of the Virtual Laboratory", comment_text(model.name)), model.span);
    out.line(fmt::format("object {} {{", plain_name(model.name) + "_surface"), model.span);
    for (std::size_t i = 0; i < surface.patches.size(); ++i) {
        const std::vector<double>& numbers = surface.patches[i];
        if (numbers.size() != patch_numbers) {
            file.diagnostics.error(surface.places[i], "a patch has four rows of four points");
            return std::nullopt;
        }
        std::string text = "    bicubic_patch(";
        for (std::size_t k = 0; k < patch_numbers; k += 3) {
            Point p{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[axis] = numbers[k + axis] - surface.contact[axis];
            Point q{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                q[axis] = (p[0] * left[axis] + p[1] * heading[axis] + p[2] * up[axis]) / surface.size;
            text += fmt::format("{}{}, {}, {}",
                                k == 0        ? ""
                                : k % 12 == 0 ? ",  "
                                              : ", ",
                                shortest(-q[0]), shortest(q[1]), shortest(-q[2]));
        }
        out.line(text + ")", surface.places[i]);
    }
    out.line("}");
    if (!surface.patches.empty()) return out;
    file.diagnostics.error(model.span, "the surface has no patch");
    return std::nullopt;
}

constexpr std::string_view surface_endings[] = {"s"};

} // namespace

Importer vlab_surface_importer() {
    return {"vlab surface", surface_endings,  is_surface, "'CONTACT POINT' and a patch",
            one_model,      translate_surface};
}

} // namespace graftal
