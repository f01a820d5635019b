#include "runtime/gpu/gpu_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "runtime/image/develop.h"

namespace graftal {

namespace {

#include "runtime/gpu/picture_spirv.h"

/// The Job of picture.comp.
struct Job {
    std::array<std::uint32_t, 4> window, picture, sequence;
};

constexpr std::size_t scene_binding = 7, film_binding = 9;
/// Pixels along each side of a group's tile.
constexpr int group_side = 8;
constexpr double seconds_a_piece = 0.03;
/// Steps of a pixel that tell that a part had no room.
constexpr float lost_steps = 1e29f;
/// Software devices end loops after some ten thousand rounds in all, so that each sample has to be a piece of
/// its own (Mesa's llvmpipe).
constexpr std::uint32_t most_samples_by_software = 1;

template<typename Value> std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
    return std::as_bytes(std::span(values));
}

} // namespace

GpuPicture::GpuPicture(Gpu& gpu, ImageSize size, const Tile& window, const Samples& samples)
    : gpu_(gpu), size_(size), window_(window), samples_(samples) {}

Status GpuPicture::prepare(const FlatModel& model, std::uint32_t frames) {
    const FlatModel::Features& has = model.features;
    const std::array<std::uint32_t, 11> constants = {
        frames,       samples_.aovs, has.stretched, has.even,   model.scene.widths.z > 0, has.patterned,
        has.pictured, has.glassy,    has.kinds,     has.paired, has.translucent};
    Status status = gpu_.load(picture_spirv, film_binding + 1, sizeof(Job), constants, scene_binding);
    const std::span<const std::byte> scene = std::as_bytes(std::span(&model.scene, 1));
    for (const std::span<const std::byte> bytes :
         {bytes_of(model.boxes), bytes_of(model.parts), bytes_of(model.nodes), bytes_of(model.looks),
          bytes_of(model.materials), bytes_of(model.triangles), bytes_of(model.texels), scene,
          bytes_of(model.lows)})
        if (status.ok()) status = gpu_.add_buffer(bytes);
    if (status.ok()) status = gpu_.add_buffer({}, window_.pixels() * sums_a_pixel() * sizeof(glm::vec4));
    return status;
}

Status GpuPicture::sample(std::uint32_t count, const std::function<bool(double)>& goes_on) {
    const std::uint32_t most = gpu_.info().is_processor ? most_samples_by_software : count;
    const double all = static_cast<double>(count - done_) * window_.height;
    double finished = 0;
    while (done_ < count) {
        // A piece is several samples of the whole window; else one sample, of as many whole rows of groups. A
        // device is full only with many pixels.
        const double affordable = seconds_a_piece * pixels_a_second_ / static_cast<double>(window_.pixels());
        const std::uint32_t samples =
            std::min({count - done_, most, static_cast<std::uint32_t>(std::clamp(affordable, 1.0, 1e6))});
        for (int row = 0; row < window_.height;) {
            if (!goes_on(finished / all)) return Status::failure("interrupted");
            const double affordable_rows = seconds_a_piece * pixels_a_second_ / samples / window_.width;
            const int rows =
                samples > 1
                    ? window_.height
                    : std::min(window_.height - row,
                               group_side * std::max(1, static_cast<int>(std::min(affordable_rows, 1e6)) /
                                                            group_side));
            const auto u = [](auto number) { return static_cast<std::uint32_t>(number); };
            const Job job{{u(window_.x), u(window_.y + row), u(window_.width), u(rows)},
                          {u(size_.width), u(size_.height), done_, samples},
                          {u(samples_.sequence), u(samples_.sequence >> 32), u(row) * u(window_.width),
                           samples_.lattice}};
            const auto groups = [](int pixels) { return (pixels + group_side - 1) / group_side; };
            double seconds = 0;
            if (Status status = gpu_.run(std::as_bytes(std::span(&job, 1)),
                                         u(groups(window_.width)) * u(groups(rows)), seconds);
                !status.ok())
                return status;
            seconds_ += seconds;
            pixels_a_second_ = static_cast<double>(rows) * window_.width * samples / std::max(seconds, 1e-6);
            finished += static_cast<double>(rows) * samples;
            row += rows;
        }
        done_ += samples;
    }
    return {};
}

Status GpuPicture::read_sums(std::vector<glm::vec4>& sums) {
    sums.resize(window_.pixels() * sums_a_pixel());
    return gpu_.read(film_binding, std::as_writable_bytes(std::span(sums)));
}

Status GpuPicture::read_aovs(const FlatModel& model, AovPicture& aovs, bool& lost) {
    std::vector<glm::vec4> sums;
    if (Status status = read_sums(sums); !status.ok()) return status;
    const float whole = samples_.lattice > 0 ? static_cast<float>(samples_.lattice * samples_.lattice)
                                             : static_cast<float>(done_);
    aovs = AovPicture(window_.pixels());
    lost = false;
    for (std::size_t i = 0; i < aovs.pixels.size(); ++i) {
        const glm::vec4 sum = sums[4 * i], normals = sums[4 * i + 1], albedos = sums[4 * i + 2],
                        nearest = sums[4 * i + 3];
        AovPixel& pixel = aovs.pixels[i];
        const std::uint32_t node =
            static_cast<std::uint32_t>(nearest.x) << 16 | static_cast<std::uint32_t>(nearest.y);
        pixel.node = node < model.source.size() ? model.source[node] : node;
        pixel.levels = static_cast<std::uint32_t>(nearest.z);
        lost = lost || nearest.w > 0;
        if (!(sum.x > 0)) continue;
        pixel.coverage = sum.x / whole;
        pixel.depth = sum.y / sum.x;
        for (int c = 0; c < 3; ++c) {
            pixel.normal[c] = normals[c] / sum.x;
            pixel.albedo[c] = albedos[c] / sum.x;
        }
    }
    return {};
}

Status GpuPicture::read(const Film& film, double noise_255, Image& picture, Seen& seen) {
    std::vector<glm::vec4> sums;
    if (Status status = read_sums(sums); !status.ok()) return status;
    seen = {};
    double noise = 0;
    std::uint64_t measured = 0;
    for (std::size_t i = 0; i < window_.pixels(); ++i) {
        const glm::vec4 sum = sums[2 * i], spread = sums[2 * i + 1];
        for (int c = 0; c < 3; ++c)
            picture.pixels[3 * i + static_cast<std::size_t>(c)] = sum.w > 0 ? sum[c] / sum.w : 0;
        seen.samples += static_cast<double>(sum.w);
        seen.rays += 1e3 * static_cast<double>(spread.w);
        seen.lost = seen.lost || spread.z >= lost_steps;
        seen.steps += 1e3 * static_cast<double>(spread.z);
        if (samples_.lattice > 0 || !(sum.w > 1)) continue;
        const double mean = spread.x, count = sum.w;
        const double error = std::sqrt(std::max<double>(spread.y, 0) / (count - 1) / count);
        const double shown =
            127.5 * (developed(mean + error, film) - developed(std::max(mean - error, 0.0), film));
        noise += shown;
        ++measured;
        if (!(shown < noise_255)) ++seen.noisy;
    }
    if (measured > 0) seen.noise_255 = noise / static_cast<double>(measured);
    return {};
}

} // namespace graftal
