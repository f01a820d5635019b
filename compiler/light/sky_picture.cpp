#include "compiler/light/sky_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/light/longitude.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Least columns and rows of cells, unless the picture's texels stand for them: half a degree and less.
constexpr int least_columns = 512, least_rows = 256;

float mean_of(const SkyPicture::Texel& texel) {
    return (texel[0] + texel[1] + texel[2]) / 3;
}

std::vector<float> mean_light(const std::vector<SkyPicture::Texel>& texels) {
    std::vector<float> light(texels.size());
    std::ranges::transform(texels, light.begin(), mean_of);
    return light;
}

/// The picture on a lattice as fine as its texels, or a whole number of times finer, with an even number of
/// rows. `look(column, row, direction, radiance * steradians)`.
struct Lattice {
    int columns, rows;

    explicit Lattice(const SkyPicture& picture) {
        const auto finer = [](int least, int size) { return std::max(1, (least + size - 1) / size); };
        columns = picture.width() * finer(least_columns, picture.width());
        rows = picture.height() * finer(least_rows, picture.height());
        if (rows % 2 != 0) rows *= 2;
    }

    template<typename Look> void for_each(const SkyPicture& picture, const Look& look) const {
        const auto height_of = [this](double row) { return std::cos(std::numbers::pi * row / rows); };
        for (int row = 0; row < rows; ++row) {
            const double size = 2 * std::numbers::pi / columns * (height_of(row) - height_of(row + 1));
            for (int column = 0; column < columns; ++column) {
                const double u = (column + 0.5) / columns;
                look(column, row, direction_at(u, 0.5 * (height_of(row) + height_of(row + 1))),
                     size * picture.radiance_at(u, (row + 0.5) / rows));
            }
        }
    }
};

/// Cells of whole lattice points; the same number of rows on both sides of the horizon.
SkyCells cells_of(const SkyPicture& picture, Rgb& on_paper) {
    const Lattice lattice(picture);
    const int across = std::max(1, lattice.columns / least_columns);
    const int half = lattice.rows / 2, down = std::max(1, lattice.rows / least_rows);
    const int half_rows = (half + down - 1) / down;
    SkyCells cells{(lattice.columns + across - 1) / across, 2 * half_rows, {}};
    cells.cells.resize(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
    lattice.for_each(picture, [&](int column, int row, Vec3 direction, Rgb power) {
        const int y = row < half ? row / down : half_rows + (row - half) / down;
        SkyCells::Cell& cell =
            cells.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.columns) +
                        static_cast<std::size_t>(column / across)];
        cell.power += glm::vec3(power);
        cell.moment += glm::vec3((power.r + power.g + power.b) / 3 * direction);
        if (direction.y > 0) on_paper += direction.y / std::numbers::pi * power;
    });
    return cells;
}

} // namespace

SkyPicture::SkyPicture(int width, int height, std::vector<Texel> texels)
    : width_(width), height_(height), texels_(std::move(texels)) {
    GRAFTAL_CHECK(width > 0 && height > 0 &&
                      texels_.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                  "SkyPicture: its size");
    sampling_ = std::make_unique<SkySampling>(width, height, mean_light(texels_));
    cells_ = std::make_unique<SkyCells>(cells_of(*this, on_paper_));
}

Rgb SkyPicture::radiance(Vec3 direction) const {
    const glm::dvec2 place = place_of(direction);
    return radiance_at(place.x, place.y);
}

Rgb SkyPicture::radiance_at(double u, double v) const {
    const TexelMix mix({u, v}, width_, height_);
    const auto rgb = [this](int column, int row) {
        const Texel& light = texel(column, row);
        return Rgb(light[0], light[1], light[2]);
    };
    return (1 - mix.down) * ((1 - mix.right) * rgb(mix.x0, mix.y0) + mix.right * rgb(mix.x1, mix.y0)) +
           mix.down * ((1 - mix.right) * rgb(mix.x0, mix.y1) + mix.right * rgb(mix.x1, mix.y1));
}

} // namespace graftal
