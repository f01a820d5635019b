#include "runtime/gpu/gpu_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include <glm/vec4.hpp>

#include "runtime/image/develop.h"

namespace graftal {

namespace {

#include "runtime/gpu/picture_spirv.h"

/// The Job of picture.comp.
struct Job {
    std::array<std::uint32_t, 4> window, picture, sequence, share;
};

constexpr std::size_t scene_binding = 7, film_binding = 9;
/// Pixels along each side of a group's tile.
constexpr int group_side = 8;
constexpr double seconds_a_piece = 0.03;
/// Software devices end loops after some ten thousand rounds in all, so that each sample has to be a piece of
/// its own (Mesa's llvmpipe).
constexpr std::uint32_t most_samples_by_software = 1;

/// `steps`: that some pixel has counted.
Status status_of(float steps) {
    return steps >= STEPS_ENDED ? Status::failure("the device ends the loops of rays before their time")
                                : Status();
}

template<typename Value> std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
    return std::as_bytes(std::span(values));
}

} // namespace

GpuPicture::GpuPicture(const std::vector<Gpu*>& gpus, ImageSize size, const Tile& window,
                       const Samples& samples)
    : size_(size), window_(window), samples_(samples) {
    for (Gpu* const gpu : gpus)
        shares_.push_back({gpu, static_cast<int>(shares_.size())});
}

Status GpuPicture::for_each_share(const std::function<Status(Share&)>& act) {
    std::vector<Status> statuses(shares_.size());
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < shares_.size(); ++i)
        others.emplace_back([&, i] { statuses[i] = act(shares_[i]); });
    statuses[0] = act(shares_[0]);
    for (std::thread& other : others)
        other.join();
    for (const Status& status : statuses)
        if (!status.ok()) return status;
    return {};
}

Status GpuPicture::prepare(const FlatModel& model, std::uint32_t frames) {
    const FlatModel::Features& has = model.features;
    const std::array<std::uint32_t, 12> constants = {
        frames,       samples_.aovs, has.stretched, has.even,   model.scene.widths.z > 0, has.patterned,
        has.pictured, has.glassy,    has.kinds,     has.paired, has.translucent,          has.crushed};
    const std::span<const std::byte> scene = std::as_bytes(std::span(&model.scene, 1));
    return for_each_share([&](const Share& share) {
        Status status =
            share.gpu->load(picture_spirv, film_binding + 1, sizeof(Job), constants, scene_binding);
        for (const std::span<const std::byte> bytes :
             {bytes_of(model.boxes), bytes_of(model.parts), bytes_of(model.nodes), bytes_of(model.looks),
              bytes_of(model.materials), bytes_of(model.triangles), bytes_of(model.texels), scene,
              bytes_of(model.lows)})
            if (status.ok()) status = share.gpu->add_buffer(bytes);
        if (status.ok())
            status = share.gpu->add_buffer({}, window_.pixels() * sums_a_pixel() * sizeof(glm::vec4));
        return status;
    });
}

Status GpuPicture::sample(std::uint32_t count, const std::function<bool(double)>& goes_on) {
    const double all = static_cast<double>(count - done_) * static_cast<double>(window_.pixels());
    std::mutex mutex;
    double drawn = 0;
    bool failed = false, interrupted = false;
    const Asks asks = [&](double pixels) {
        const std::lock_guard lock(mutex);
        drawn += pixels;
        interrupted = interrupted || !goes_on(std::min(drawn / all, 1.0));
        return !failed && !interrupted;
    };
    Status status = for_each_share([&](Share& share) {
        Status of_share = sample(share, count, asks);
        const std::lock_guard lock(mutex);
        failed = failed || !of_share.ok();
        return of_share;
    });
    if (status.ok() && interrupted) status = Status::failure("interrupted");
    if (status.ok()) done_ = count;
    return status;
}

Status GpuPicture::sample(Share& share, std::uint32_t count, const Asks& goes_on) const {
    const std::uint32_t most = share.gpu->info().is_processor ? most_samples_by_software : count;
    const int in_turn = static_cast<int>(shares_.size());
    const int all_rows = (window_.height + group_side - 1) / group_side; // of tiles, as all rows here
    const int own_rows = (all_rows - share.first + in_turn - 1) / in_turn;
    const double row_pixels = static_cast<double>(group_side) * window_.width;
    double pixels = 0;
    for (std::uint32_t done = done_; done < count && own_rows > 0;) {
        // A piece is several samples of all rows; else one sample, of as many rows as it can be. A device is
        // full only with many pixels.
        const double affordable = seconds_a_piece * share.pixels_a_second / row_pixels;
        const std::uint32_t samples = std::min(
            {count - done, most, static_cast<std::uint32_t>(std::clamp(affordable / own_rows, 1.0, 1e6))});
        for (int row = 0; row < own_rows;) {
            if (!goes_on(pixels)) return {};
            const int rows =
                samples > 1 ? own_rows
                            : std::min(own_rows - row, static_cast<int>(std::clamp(affordable, 1.0, 1e6)));
            const int top = group_side * (share.first + row * in_turn);
            const auto u = [](auto number) { return static_cast<std::uint32_t>(number); };
            const Job job{{u(window_.x), u(window_.y + top), u(window_.width), u(window_.height - top)},
                          {u(size_.width), u(size_.height), done, samples},
                          {u(samples_.sequence), u(samples_.sequence >> 32), u(top) * u(window_.width),
                           samples_.lattice},
                          {u(in_turn)}};
            double seconds = 0;
            if (Status status =
                    share.gpu->run(std::as_bytes(std::span(&job, 1)),
                                   u((window_.width + group_side - 1) / group_side) * u(rows), seconds);
                !status.ok())
                return status;
            pixels = row_pixels * rows * samples;
            share.seconds += seconds;
            share.pixels_a_second = pixels / std::max(seconds, 1e-6);
            row += rows;
        }
        done += samples;
    }
    return {};
}

double GpuPicture::seconds() const {
    return std::ranges::max(shares_, {}, &Share::seconds).seconds;
}

Status GpuPicture::read_sums(std::vector<glm::vec4>& sums) {
    sums.resize(window_.pixels() * sums_a_pixel());
    const std::size_t a_row = sums_a_pixel() * static_cast<std::size_t>(group_side * window_.width);
    const std::size_t a_piece = shares_.size() == 1 ? sums.size() : a_row;
    return for_each_share([&](const Share& share) {
        Status status;
        for (std::size_t at = static_cast<std::size_t>(share.first) * a_piece;
             at < sums.size() && status.ok(); at += shares_.size() * a_piece) {
            const auto own = std::span(sums).subspan(at, std::min(a_piece, sums.size() - at));
            status = share.gpu->read(film_binding, std::as_writable_bytes(own), at * sizeof(glm::vec4));
        }
        return status;
    });
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
        if (Status status = status_of(nearest.w); !status.ok()) return status;
        lost = lost || nearest.w >= STEPS_LOST;
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
        if (Status status = status_of(spread.z); !status.ok()) return status;
        seen.lost = seen.lost || spread.z >= STEPS_LOST;
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
