#include "compiler/povray/emit/palette.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int palette_digits = 7;
constexpr int step_digits = 9;
constexpr int widest_picture = 4096;

void append_colour(std::string& out, Rgb rgb) {
    out += "rgb <";
    for (int i = 0; i < 3; ++i) {
        if (i > 0) out += ",";
        append_number(out, rgb[i], palette_digits);
    }
    out += ">";
}

/// Each colour from one step to the next: two entries at each step, the old colour and the new.
std::string colour_map(const Palette& palette, const std::string& clear) {
    std::string text = "uv_mapping gradient x color_map {";
    const double count = static_cast<double>(palette.size());
    for (std::size_t i = 0; i < palette.size(); ++i)
        for (const std::size_t edge : {i, i + 1}) {
            text += edge == i ? "\n    [" : " [";
            append_number(text, static_cast<double>(edge) / count, step_digits);
            text += " ";
            append_colour(text, palette[i]);
            if (!clear.empty()) text += " " + clear;
            text += "]";
        }
    return text + " }";
}

} // namespace

PaletteLayout::PaletteLayout(std::uint32_t slot_count) : width_(static_cast<int>(std::max(slot_count, 1u))) {
    if (slot_count <= colour_map_colours) return;
    // About square, and a power of two wide, so that the middles of pixels are short binary fractions.
    width_ = 16;
    while (width_ < widest_picture && static_cast<std::uint64_t>(width_) * width_ < slot_count)
        width_ *= 2;
    height_ = static_cast<int>((slot_count - 1) / static_cast<std::uint32_t>(width_) + 1);
}

std::pair<double, double> PaletteLayout::uv(std::uint32_t slot) const {
    const auto width = static_cast<std::uint32_t>(width_);
    const double u = (slot % width + 0.5) / width_;
    if (!picture()) return {u, 0.5};
    return {u, 1 - (slot / width + 0.5) / height_};
}

std::string palette_pigment(const Palette& palette, const std::string& file_name, const std::string& clear) {
    if (!PaletteLayout(static_cast<std::uint32_t>(palette.size())).picture())
        return colour_map(palette, clear);
    return fmt::format("uv_mapping image_map {{ png \"{}\" gamma 1.0 {}}}", file_name, clear_image(clear));
}

std::string clear_image(const std::string& clear) {
    std::string text = clear;
    for (const std::string_view word : {"filter", "transmit"})
        if (const std::size_t at = text.find(word); at != std::string::npos)
            text.insert(at + word.size(), " all");
    return text.empty() ? text : text + " ";
}

PaletteImage palette_image(const Palette& palette, std::string file_name) {
    const PaletteLayout layout(static_cast<std::uint32_t>(palette.size()));
    return {std::move(file_name), layout.width(), layout.height(), palette};
}

} // namespace graftal
