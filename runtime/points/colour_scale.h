#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/tint.h"

namespace graftal {

/// `black`, `white`, or `#rrggbb` in sRGB: in linear light. Nothing if the text is none of these.
std::optional<Rgb> parse_colour(std::string_view text);

/// Colours from few points to many.
class ColourScale {
  public:
    /// Violet over green to yellow, in even steps of lightness.
    ColourScale();

    /// A name of names(), or two to 64 colours in the way of parse_colour(), with commas between them, in
    /// even distances.
    static std::optional<ColourScale> parse(std::string_view text);
    /// "gold, ice, ...": for messages.
    static std::string names();

    /// In linear light. x is clamped to [0, 1]; between two colours it mixes their sRGB values.
    Rgb at(double x) const;

  private:
    explicit ColourScale(std::vector<Rgb> srgb) : srgb_(std::move(srgb)) {}

    std::vector<Rgb> srgb_; ///< at least two
};

} // namespace graftal
