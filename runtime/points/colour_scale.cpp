#include "runtime/points/colour_scale.h"

#include <algorithm>
#include <utility>

#include "compiler/support/srgb.h"

namespace graftal {

namespace {

constexpr std::size_t most_colours = 64;

/// A name, and what it stands for in words of its own language.
constexpr std::pair<std::string_view, std::string_view> named[] = {
    {"viridis", "#401a73,#385299,#21858f,#40b36b,#add638,#fff28c"},
    {"gold", "#0a0502,#4a2408,#a8641a,#e0a83a,#ffe49a,#fffaf0"},
    {"ice", "#020611,#0b2a55,#1f6fa8,#6cb8dc,#cdeaf5,#ffffff"},
    {"ember", "#050102,#3d0510,#96160f,#e0501a,#ffb347,#fff6d5"},
    {"grey", "black,white"},
    {"ink", "#fbf9f4,#8a94a6,#2b3550,#0a0e1c"},
};

std::optional<Rgb> parse_srgb(std::string_view text) {
    if (text == "black") return Rgb(0.0);
    if (text == "white") return Rgb(1.0);
    if (text.size() != 7 || text.front() != '#') return std::nullopt;
    return srgb_from_hex(text.substr(1));
}

} // namespace

std::optional<Rgb> parse_colour(std::string_view text) {
    const std::optional<Rgb> srgb = parse_srgb(text);
    if (!srgb) return std::nullopt;
    return linear_from_srgb(*srgb);
}

ColourScale::ColourScale() : ColourScale(*parse(named[0].first)) {}

std::optional<ColourScale> ColourScale::parse(std::string_view text) {
    for (const auto& [name, colours] : named)
        if (text == name) return parse(colours);
    std::vector<Rgb> srgb;
    for (std::size_t begin = 0; begin <= text.size() && srgb.size() <= most_colours;) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::optional<Rgb> colour = parse_srgb(text.substr(begin, end - begin));
        if (!colour) return std::nullopt;
        srgb.push_back(*colour);
        begin = end + 1;
    }
    if (srgb.size() < 2 || srgb.size() > most_colours) return std::nullopt;
    return ColourScale(std::move(srgb));
}

std::string ColourScale::names() {
    std::string text;
    for (const auto& [name, colours] : named)
        text.append(text.empty() ? "" : ", ").append(name);
    return text;
}

Rgb ColourScale::at(double x) const {
    const double place = (x > 0 ? std::min(x, 1.0) : 0.0) * static_cast<double>(srgb_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), srgb_.size() - 2);
    const double t = place - static_cast<double>(i);
    return linear_from_srgb((1 - t) * srgb_[i] + t * srgb_[i + 1]);
}

} // namespace graftal
