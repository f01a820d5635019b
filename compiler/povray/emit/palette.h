#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/output.h"

namespace graftal {

/// A palette of up to this many colours is a colour map, whose 256 entries make that many hard steps; a
/// larger one is a picture.
inline constexpr std::uint32_t colour_map_colours = 128;

/// Layout of a palette's slots in texture space. Meshes and palettes know it from the number of slots alone.
class PaletteLayout {
  public:
    explicit PaletteLayout(std::uint32_t slot_count);

    bool picture() const { return height_ > 0; }
    int width() const { return width_; }
    int height() const { return height_; } ///< 0 for a colour map
    /// The middle of the slot's step or pixel, v upwards.
    std::pair<double, double> uv(std::uint32_t slot) const;

  private:
    int width_ = 1;
    int height_ = 0;
};

/// The pigment of a palette: `uv_mapping ...`, a colour map, or a picture of the given file name. `clear`:
/// what each colour says of light that goes through, such as "filter 0.5"; or nothing.
std::string palette_pigment(const Palette& palette, const std::string& file_name,
                            const std::string& clear = {});

/// The modifier for all colours of an image map, with a space behind it; nothing for nothing.
std::string clear_image(const std::string& clear);

/// The picture, over the palette's own colours. Requires a palette whose layout is one.
PaletteImage palette_image(const Palette& palette, std::string file_name);

} // namespace graftal
