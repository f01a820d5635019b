#include "runtime/points/gpu_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

namespace graftal {

namespace points_kernel {
using glm::uvec4;
using glm::vec4;
#include "runtime/points/kernel/job.glsl"
} // namespace points_kernel

namespace {

#include "runtime/points/points_64_spirv.h"
#include "runtime/points/points_spirv.h"

/// The kernel's buffers that are read back, and the number of all.
constexpr std::size_t cells_binding = 6, totals_binding = 7, bindings = 12;

constexpr std::uint32_t group_size = GROUP_SIZE, cells_of_thread = CELLS_OF_THREAD;
constexpr std::size_t bytes_of_walker = 64;
constexpr double seconds_a_piece = 0.04;
/// Software devices end loops after some ten thousand rounds, those of climbs among them.
constexpr std::uint64_t most_points_by_software = 1u << 8; // of a walker
constexpr std::uint64_t most_points_a_piece = 1u << 31;
/// Moves of all walkers until they have settled: of them a piece cannot be divided.
constexpr std::uint64_t most_to_settle = 1u << 30, most_to_settle_by_formulas = 1u << 28;
/// A pixel's share of all points from which on more of them may come while a cell is unpacked than it holds.
constexpr double most_packed_share = 1.0 / 1024;

template<typename Value> std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
    return std::as_bytes(std::span(values));
}

/// One for a thousand points, as far as a device is filled by them. All devices make the same points.
std::uint32_t walkers_for(std::uint64_t points, const FlatGame& game) {
    const std::uint64_t settled =
        (game.formulas ? most_to_settle_by_formulas : most_to_settle) / (game.settling + 1);
    const std::uint64_t most = std::min<std::uint64_t>(settled, 1u << 20);
    return static_cast<std::uint32_t>(
        std::max<std::uint64_t>(std::min(std::bit_ceil(points / 1024 + 1), most), group_size));
}

std::uint32_t groups_for(std::uint64_t threads) {
    return static_cast<std::uint32_t>((threads + group_size - 1) / group_size);
}

std::uint32_t words_of_cell(std::uint32_t channels) {
    return channels == 0 ? 1 : channels == 1 ? 2 : 4;
}

/// Levels of a colour's channel. Sums of 32 bits hold 4 million of them, or 16.
std::uint32_t levels_of(std::uint32_t channels) {
    return channels == 1 ? 1023 : 255;
}

/// How many points a cell has room for.
double room_of_cell(std::uint32_t channels) {
    return channels == 0 ? 0x1p32 - 1 : std::floor((0x1p32 - 1) / levels_of(channels));
}

std::uint64_t points_of_first_piece(double room) {
    return static_cast<std::uint64_t>(std::min(room, 0x1p24));
}

} // namespace

/// The kernel's.
struct GpuPoints::Job : points_kernel::Job {
    std::size_t cells() const { return std::size_t{window.x} * window.w; }
    std::size_t first_cell() const { return std::size_t{window.x} * window.z; }
};

GpuPoints::Colours GpuPoints::colours_of(FlatGame& game) {
    std::vector<glm::vec3> seen;
    for (std::size_t i = 3; i < game.moves.size(); i += FlatGame::numbers_of_move)
        if (const glm::vec4& paint = game.moves[i]; paint.w < 1)
            seen.push_back(glm::vec3(paint) / (1 - paint.w));
    if (game.sees_through || game.climbs || seen.empty())
        for (const glm::vec4& colour : game.colours)
            seen.emplace_back(colour);
    constexpr float same = 1e-4f;
    const auto farthest = [&](glm::vec3 from) {
        return *std::ranges::max_element(
            seen, {}, [&](const glm::vec3& colour) { return glm::distance(colour, from); });
    };
    Colours colours;
    colours.first = farthest(seen.front());
    colours.last = farthest(colours.first);
    const glm::vec3 along = colours.last - colours.first;
    const float length = glm::length(along);
    if (length < same) return colours;
    const auto place_on_line = [&](glm::vec3 colour) {
        return glm::dot(colour - colours.first, along) / (length * length);
    };
    const bool on_line = std::ranges::all_of(seen, [&](const glm::vec3& colour) {
        return glm::distance(colour, colours.first + place_on_line(colour) * along) < same;
    });
    colours.channels = on_line ? 1 : 3;
    if (!on_line) return colours;
    for (std::size_t i = 3; i < game.moves.size(); i += FlatGame::numbers_of_move)
        if (glm::vec4& paint = game.moves[i]; paint.w < 1)
            paint.x = (1 - paint.w) * place_on_line(glm::vec3(paint) / (1 - paint.w));
    for (glm::vec4& colour : game.colours)
        colour.x = place_on_line(colour);
    return colours;
}

Status GpuPoints::load(const FlatGame& game, const Work& work, std::uint32_t walkers_of_it,
                       std::size_t cells_of_it) {
    const std::array<std::uint32_t, 9> constants = {game.flat && !work.perspective,
                                                    work.perspective,
                                                    colours_.channels,
                                                    game.climbs,
                                                    game.leaves,
                                                    game.wide,
                                                    game.sources.count > 0,
                                                    game.formulas,
                                                    std::max(game.slots, 6u)};
    Status status =
        gpu_.load(sums_ != Sums::apart ? std::span<const std::uint32_t>(points_64_spirv) : points_spirv,
                  bindings, sizeof(Job), constants);
    for (const std::span<const std::byte> bytes :
         {bytes_of(game.choices), bytes_of(game.moves), bytes_of(game.links), bytes_of(game.states),
          bytes_of(game.colours)})
        if (status.ok()) status = gpu_.add_buffer(bytes);
    totals_.resize(std::max<std::size_t>(groups_for(walkers_of_it),
                                         groups_for((cells_of_it + cells_of_thread - 1) / cells_of_thread)));
    for (const std::size_t size :
         {walkers_of_it * bytes_of_walker,
          cells_of_it * words_of_cell(colours_.channels) * sizeof(std::uint32_t),
          totals_.size() * sizeof(glm::uvec4), packs_ ? cells_of_it * sizeof(std::uint64_t) : 0})
        if (status.ok()) status = gpu_.add_buffer({}, size);
    for (const std::span<const std::byte> bytes :
         {bytes_of(game.steps), bytes_of(game.numbers), bytes_of(game.forms)})
        if (status.ok()) status = gpu_.add_buffer(bytes);
    return status;
}

Status GpuPoints::run(const Job& job, std::uint32_t groups, double& seconds) {
    Status status = gpu_.run(std::as_bytes(std::span(&job, 1)), groups, seconds);
    if (!status.ok()) return status;
    seconds_ += seconds;
    return gpu_.read(totals_binding, std::as_writable_bytes(std::span(totals_.data(), groups)));
}

Status GpuPoints::sweep(Job job, std::uint64_t& most, std::uint64_t& sum) {
    job.work.w = (job.work.w & JOB_PACKS) | JOB_SWEEPS;
    const std::uint32_t groups = groups_for((job.cells() + cells_of_thread - 1) / cells_of_thread);
    double seconds = 0;
    Status status = run(job, groups, seconds);
    most = sum = 0;
    for (std::uint32_t group = 0; group < groups && status.ok(); ++group) {
        most = std::max<std::uint64_t>(most, totals_[group].x);
        sum += totals_[group].y + (std::uint64_t{totals_[group].z} << 16);
    }
    return status;
}

Status GpuPoints::flush(Accumulation& picture, const Job& job) {
    const std::uint32_t words = words_of_cell(colours_.channels), levels = levels_of(colours_.channels);
    constexpr std::size_t cells_at_once = 1u << 20;
    std::vector<std::uint32_t> some(cells_at_once * words);
    for (std::size_t first = 0; first < job.cells(); first += cells_at_once) {
        const std::size_t number = std::min(cells_at_once, job.cells() - first);
        const std::span<std::uint32_t> read(some.data(), number * words);
        if (Status status =
                gpu_.read(cells_binding, std::as_writable_bytes(read), first * words * sizeof(std::uint32_t));
            !status.ok())
            return status;
        for (std::size_t i = 0; i < number; ++i) {
            const std::uint32_t* const cell = &some[i * words];
            const std::uint32_t count = words == 1 ? cell[0] : cell[1];
            if (count == 0) continue;
            double rgb[3];
            for (int c = 0; c < 3; ++c)
                rgb[c] = words == 4   ? static_cast<double>(cell[c == 0 ? 0 : c + 1]) / levels
                         : words == 1 ? static_cast<double>(count) * static_cast<double>(colours_.first[c])
                                      : static_cast<double>(count) * static_cast<double>(colours_.first[c]) +
                                            static_cast<double>(cell[0]) / levels *
                                                static_cast<double>(colours_.last[c] - colours_.first[c]);
            picture.add(job.first_cell() + first + i, count, rgb);
        }
    }
    return gpu_.clear(cells_binding);
}

Status GpuPoints::play(Accumulation& picture, const Work& work, Job job) {
    const std::uint64_t moves_of_each = work.points / job.work[0];
    const double room = room_of_cell(colours_.channels);
    const std::uint64_t most_moves = std::max<std::uint64_t>(
        gpu_.info().is_processor ? most_points_by_software : most_points_a_piece / job.work[0], 1);
    // The first points all have room in one cell, with one more of each walker, which the last piece may
    // have. Later pieces are larger, by where these fell.
    std::uint64_t piece = std::max<std::uint64_t>(points_of_first_piece(room) / job.work[0], 2) - 1;
    std::uint64_t inside = 0, made = 0; // since the last flush
    job.work[3] = JOB_BEGINS;
    for (std::uint64_t done = 0; done <= moves_of_each;) {
        const double whole = static_cast<double>(moves_of_each + 1);
        if (!work.goes_on(share_ + static_cast<double>(done) / whole * static_cast<double>(job.window[3]) /
                                       static_cast<double>(job.window[1])))
            return Status::failure("interrupted");
        const std::uint64_t number = std::min({piece, most_moves, moves_of_each - done});
        const bool last = done + number == moves_of_each;
        job.work[1] = static_cast<std::uint32_t>(number);
        job.work[2] = last ? static_cast<std::uint32_t>(work.points % job.work[0]) : 0;
        double seconds = 0;
        const std::uint32_t groups = groups_for(job.work[0]);
        if (Status status = run(job, groups, seconds); !status.ok()) return status;
        for (std::uint32_t group = 0; group < groups; ++group)
            inside += totals_[group].x;
        if (std::ranges::any_of(std::span(totals_).first(groups),
                                [](const glm::uvec4& seen) { return seen.y > 0; }))
            return Status::failure("in single precision an orbit goes astray");
        made += number * job.work[0] + job.work[2];
        done += number;
        std::uint64_t most = 0, sum = 0;
        if (Status status = sweep(job, most, sum); !status.ok()) return status;
        // A number that flows over is short by 2^10 or 2^32, for which nothing makes up. Its colours have
        // room for more.
        if (sum != inside) return Status::failure("GPU: a pixel has more points than its sums hold");
        if (last) break;
        job.work.w = 0;
        // The fullest cell grows by as much again for as many points, and by chance a little more.
        const double growth = 1.5 * static_cast<double>(most + 64) / static_cast<double>(made);
        if (packs_ && growth <= most_packed_share) job.work.w = JOB_PACKS;
        const double affordable = seconds_a_piece / std::max(seconds, 1e-6) * static_cast<double>(number);
        piece = static_cast<std::uint64_t>(std::clamp(
            std::min({affordable, 8.0 * static_cast<double>(number), room / 2 / growth / job.work[0]}), 1.0,
            static_cast<double>(most_moves)));
        if (static_cast<double>(most) + growth * static_cast<double>(piece) * job.work[0] > room) {
            if (Status status = flush(picture, job); !status.ok()) return status;
            inside = made = 0;
        }
    }
    return flush(picture, job);
}

bool is_sharp_in_single(const PointSource& source, const PointProjection& projection) {
    constexpr double precision = 0x1p-24, sharp_px = 1.0 / 16;
    std::vector<ChaosPoint> points(4096);
    if (!source.stream(0, {})->fill(points)) return false;
    const Affine seen_from_world = projection.picture_from_world();
    double farthest = 0, parts = 0, before = 0;
    for (const ChaosPoint& point : points) {
        const Vec3 seen = seen_from_world(point.place);
        farthest = std::max({farthest, std::abs(seen.x), std::abs(seen.y)});
        if (projection.perspective() && !(seen.z > 0)) continue;
        parts += projection.perspective() ? 1 / seen.z : 1;
        ++before;
    }
    return farthest * precision * parts <= sharp_px * before;
}

Status GpuPoints::add_to(Accumulation& picture, FlatGame game, const Work& work) {
    colours_ = colours_of(game);
    packs_ = sums_ == Sums::packed && colours_.channels == 3;
    const ImageSize size = picture.size();
    const auto width = static_cast<std::uint32_t>(size.width),
               height = static_cast<std::uint32_t>(size.height);
    const std::uint64_t bytes_of_row =
        std::uint64_t{width} * words_of_cell(colours_.channels) * sizeof(std::uint32_t);
    const std::uint64_t most_bytes =
        std::min({work.most_bytes, gpu_.info().most_buffer_bytes, gpu_.info().memory_bytes / 2});
    const auto rows =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most_bytes / bytes_of_row, 1, height));
    Job job;
    job.work[0] = walkers_for(work.points, game);
    job.start = {game.start.first, game.start.count, game.settling,
                 static_cast<std::uint32_t>(game.colours.size() - 1)};
    job.orbit = {game.links.size() - 1, game.core_colour, game.first_form,
                 std::bit_cast<std::uint32_t>(game.restart)};
    job.sources = {game.sources.first, game.sources.count, 0, 0};
    job.origin = game.origin;
    if (Status status = load(game, work, job.work[0], std::size_t{width} * rows); !status.ok()) return status;
    // Where not all rows have room, each band of them takes the same points again.
    for (std::uint32_t row = 0; row < height; row += rows) {
        job.window = {width, height, row, std::min(rows, height - row)};
        job.more = {static_cast<std::uint32_t>(work.seed), static_cast<std::uint32_t>(work.seed >> 32),
                    static_cast<std::uint32_t>(job.cells()), levels_of(colours_.channels)};
        share_ = static_cast<double>(row) / height;
        if (Status status = play(picture, work, job); !status.ok()) return status;
    }
    return {};
}

} // namespace graftal
