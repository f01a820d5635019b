#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "compiler/light/sky_cells.h"
#include "compiler/light/sky_sampling.h"
#include "compiler/support/affine.h"
#include "compiler/support/status.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Radiance from all directions, as a picture of longitude and latitude gives it. Its middle lies towards
/// (1, 0, 0), its top is (0, 1, 0), and z grows to the right of the middle: nothing is mirrored for an eye
/// inside (as in Blender, with y up). Light runs linearly between the middles of texels, round the circle,
/// and ends with the first and last row.
class SkyPicture {
  public:
    using Texel = std::array<float, 3>; ///< linear red, green, blue

    /// Requires width, height >= 1; all their texels, row by row from the top, finite and not negative.
    SkyPicture(int width, int height, std::vector<Texel> texels);

    int width() const { return width_; }
    int height() const { return height_; }

    /// The radiance from a direction (unit).
    Rgb radiance(Vec3 direction) const;
    /// The radiance at u to the right and v downwards, in [0, 1]: as a picture.
    Rgb radiance_at(double u, double v) const;
    /// The irradiance of a surface that faces up, over pi.
    Rgb on_paper() const { return on_paper_; }

    const std::vector<Texel>& texels() const { return texels_; }
    const SkySampling& sampling() const { return *sampling_; }
    const SkyCells& cells() const { return *cells_; }

  private:
    const Texel& texel(int x, int y) const {
        return texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)];
    }

    int width_, height_;
    std::vector<Texel> texels_;
    Rgb on_paper_{0.0};
    std::unique_ptr<const SkySampling> sampling_;
    std::unique_ptr<const SkyCells> cells_;
};

/// The sky picture of a file, for a compiler.
struct LoadedSkyPicture {
    std::shared_ptr<const SkyPicture> picture;
    int file_width = 0, file_height = 0;
    std::uint64_t mended = 0; ///< pixels that were no light: negative, not a number, or beyond most_radiance
};

inline constexpr float most_radiance = 1e6f;
/// Most texels of a loaded picture, across and down; larger pictures are reduced.
inline constexpr int most_sky_columns = 4096;

/// The function that a compiler asks for the picture in a file.
using LoadSkyPicture = std::function<Status(const std::string& path, LoadedSkyPicture& loaded)>;

} // namespace graftal
