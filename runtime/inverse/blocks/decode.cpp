#include "runtime/inverse/blocks/decode.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graftal {

namespace {

constexpr std::size_t blocks_a_job = 256;
constexpr double levels_left = 0.1; ///< from the attractor

/// The first new pixel whose middle is at `place` or behind it.
int first_pixel(double place, double scale) {
    return static_cast<int>(std::ceil(place * scale - 0.5));
}

/// The value at a share of the way.
float mixed(float from, float to, float share) {
    return from + share * (to - from);
}

double contraction_of(const CodedPlane& plane) {
    int steepest = 0;
    for (const BlockMap& block : plane.blocks)
        steepest = std::max(steepest, std::abs(block.slope));
    return static_cast<double>(steepest) / slope_steps;
}

} // namespace

PlaneIteration::PlaneIteration(const CodedPlane& plane, double coded_width, double coded_height, int width,
                               int height)
    : plane_(plane), scale_x_(width / coded_width), scale_y_(height / coded_height), columns_(width),
      rows_(height) {
    if (contraction_of(plane) > 0) {
        columns_ = std::max(width, first_pixel(plane.grid.padded_width(), scale_x_));
        rows_ = std::max(height, first_pixel(plane.grid.padded_height(), scale_y_));
    }
    for (int side = least_side; side <= largest_side; side *= 2)
        pools_.emplace_back(plane.grid, side, plane.pool_bits);
}

PlaneIteration::Tap PlaneIteration::tap(double place, double scale, int count) const {
    const double at = std::clamp(place * scale - 0.5, 0.0, count - 1.0);
    const int first = static_cast<int>(at);
    return {first, std::min(first + 1, count - 1), static_cast<float>(at - first)};
}

float PlaneIteration::fill(const BlockMap& block, const LevelPlane& from, LevelPlane& to) const {
    const int left = first_pixel(block.x, scale_x_),
              right = std::min(columns_, first_pixel(block.x + block.side, scale_x_));
    const int top = first_pixel(block.y, scale_y_),
              bottom = std::min(rows_, first_pixel(block.y + block.side, scale_y_));
    const float scale = block.scale(), offset = block.offset();
    float moved = 0;
    const auto set = [&](int x, int y, float value) {
        const std::size_t pixel = to.index(x, y);
        moved = std::max(moved, std::abs(value - from.levels[pixel]));
        to.levels[pixel] = value;
    };
    if (block.slope == 0) {
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x)
                set(x, y, offset);
        return moved;
    }
    const DomainPool& pool = *std::find_if(
        pools_.begin(), pools_.end(), [&](const DomainPool& some) { return some.side == 2 * block.side; });
    const int domain_x = pool.x(block.domain), domain_y = pool.y(block.domain);
    // Isometries take columns to columns, or all of them to rows: a tap for each of both.
    const bool swaps = block.isometry & 4;
    std::vector<Tap> of_columns, of_rows;
    const auto place_of = [&](double u, double v) {
        return BlockPlace<double>{u, v}.under(block.isometry, block.side);
    };
    for (int x = left; x < right; ++x) {
        const auto place = place_of((x + 0.5) / scale_x_ - block.x, (x + 0.5) / scale_x_ - block.x);
        of_columns.push_back(swaps ? tap(domain_y + 2 * place.v, scale_y_, rows_)
                                   : tap(domain_x + 2 * place.u, scale_x_, columns_));
    }
    for (int y = top; y < bottom; ++y) {
        const auto place = place_of((y + 0.5) / scale_y_ - block.y, (y + 0.5) / scale_y_ - block.y);
        of_rows.push_back(swaps ? tap(domain_x + 2 * place.u, scale_x_, columns_)
                                : tap(domain_y + 2 * place.v, scale_y_, rows_));
    }
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            Tap across = of_columns[static_cast<std::size_t>(x - left)];
            Tap down = of_rows[static_cast<std::size_t>(y - top)];
            if (swaps) std::swap(across, down);
            const float above =
                mixed(from.at(across.first, down.first), from.at(across.second, down.first), across.share);
            const float below =
                mixed(from.at(across.first, down.second), from.at(across.second, down.second), across.share);
            set(x, y, scale * mixed(above, below, down.share) + offset);
        }
    return moved;
}

float PlaneIteration::apply(const LevelPlane& from, LevelPlane& to, const Workers& workers,
                            const CancelFlag& cancel) const {
    const std::size_t jobs = (plane_.blocks.size() + blocks_a_job - 1) / blocks_a_job;
    std::vector<float> moved(jobs);
    workers.for_each(jobs, [&](int, std::uint64_t job) {
        if (cancel.raised()) throw Cancelled();
        const std::size_t end = std::min(plane_.blocks.size(), (job + 1) * blocks_a_job);
        for (std::size_t i = job * blocks_a_job; i < end; ++i)
            moved[job] = std::max(moved[job], fill(plane_.blocks[i], from, to));
    });
    return moved.empty() ? 0 : *std::max_element(moved.begin(), moved.end());
}

namespace {

/// The plane without its margin.
LevelPlane cropped(const LevelPlane& plane, int width, int height) {
    LevelPlane inner(width, height);
    for (int y = 0; y < height; ++y)
        std::copy_n(&plane.levels[plane.index(0, y)], width, &inner.levels[inner.index(0, y)]);
    return inner;
}

PlaneIteration iteration_of(const BlockPicture& picture, std::size_t plane, int width, int height) {
    const double halves = picture.is_half(plane) ? 0.5 : 1;
    return {picture.planes[plane], halves * picture.width, halves * picture.height, width, height};
}

} // namespace

double contraction_of(const BlockPicture& picture) {
    double largest = 0;
    for (const CodedPlane& plane : picture.planes)
        largest = std::max(largest, contraction_of(plane));
    return largest;
}

std::uint64_t decoding_bytes(const BlockPicture& picture, int width, int height) {
    const std::uint64_t sample = sizeof(float);
    std::uint64_t margins = 0;
    for (std::size_t i = 0; i < picture.planes.size(); ++i)
        margins = std::max(margins, iteration_of(picture, i, width, height).samples());
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    const std::uint64_t planes = picture.planes.size() * pixels;
    return sample * (planes + std::max(2 * margins, planes)); // after the iteration: the picture
}

PicturePlanes decode_blocks(const BlockPicture& picture, int width, int height, const Workers& workers,
                            const Control& control, const std::function<void(double)>& on_progress) {
    PicturePlanes decoded{width, height, picture.colour, picture.alpha, {}};
    WorkMeter meter(control, "block decoding", 1, 1 / decoded_pixels_a_second);
    for (std::size_t i = 0; i < picture.planes.size(); ++i) {
        const CodedPlane& plane = picture.planes[i];
        const PlaneIteration iteration = iteration_of(picture, i, width, height);
        const double s = contraction_of(plane), goal = s > 0 ? levels_left * (1 - s) / s : 255;
        LevelPlane now = iteration.grey(), next = now;
        for (double moved = 2 * goal; moved > goal;) {
            meter.add(now.levels.size());
            moved = iteration.apply(now, next, workers, control.cancel);
            std::swap(now, next);
            const double way = std::log(256 / std::clamp(moved, goal, 256.0)) / std::log(256 / goal);
            if (on_progress)
                on_progress((static_cast<double>(i) + way) / static_cast<double>(picture.planes.size()));
        }
        decoded.planes.push_back(cropped(now, width, height));
    }
    return decoded;
}

} // namespace graftal
