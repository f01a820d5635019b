#include "runtime/trace/picture_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/support/check.h"
#include "compiler/support/counter_random.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/pixel_filter.h"
#include "runtime/trace/shade/sample_stream.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

namespace {

/// Pixels along each side of a tile: enough to share edges of, and some hundred tiles to a picture.
constexpr int tile_size = 32;

/// After which the noise is measured: enough to see rare light, and whole rounds of Sobol's sequence.
constexpr int samples_a_round = 16;

/// Rays of a probe, for one thread at a time.
constexpr std::uint64_t probe_piece = 4;

/// 1 / g and 1 / g^2 of the plastic number g, g^3 = g + 1: no rational is near their combinations.
const glm::dvec2 r2_step(0.7548776662466927, 0.5698402909980532);

/// One thread's tools, and what it keeps for their memory.
class Worker {
  public:
    Worker(const TraceModel& model, const ShaderLimits& limits, const TraceControl& control)
        : rays_(model.view), traversal_(model),
          shader_(model.view, traversal_, limits, model.textures.of_ground), film_(model.view.film),
          view_(model.view), cut_(model.prepared.cut), control_(control) {}

    /// The tile of the whole picture, as far as it lies in the window, which `picture` and `aovs` show; the
    /// latter may be null. False if it was cancelled before the last ray.
    bool trace(const Sampling& sampling, const Tile& tile, const Tile& window, Image& picture,
               AovPicture* aovs) {
        aovs_ = aovs;
        named_ = aovs && !aovs->mattes.empty() ? &cut_ : nullptr;
        traversal_.tell_instances(named_ != nullptr);
        window_ = window;
        if (sampling.block > 1) return trace_blocks(sampling.block, tile, picture);
        const Tile seen = common(tile, window);
        if (sampling.most_samples > 0) return trace_samples(sampling, seen, picture);
        if (!sampling.antialias) return trace_blocks(1, seen, picture);
        return trace_lattice(sampling.steps(), seen, picture);
    }

    /// The features of the tile's pixels, each by rays through its square and the eight around it.
    bool trace_features(int rays, const Tile& tile, const Tile& window,
                        std::vector<PixelFeatures>& features) {
        window_ = window;
        FeatureSums sums(tile);
        const Tile around =
            common({tile.x - 1, tile.y - 1, tile.width + 2, tile.height + 2}, whole_of(view_.size));
        std::array<Ray, together> ahead;
        std::array<glm::dvec2, together> places;
        std::vector<SampleStream> randoms(ahead.size(), SampleStream(0, 0));
        std::size_t count = 0;
        const auto look = [&] {
            shader_.look_ahead(std::span(ahead).first(count), ahead_);
            for (std::size_t i = 0; i < count; ++i) {
                ++camera_rays_;
                SurfaceHit met;
                traversal_.begin_path();
                PixelFeatures seen{};
                if (shader_.first_hit(ahead[i], met, ahead_, i))
                    seen = features_of(AovSample(met, ahead[i], view_), view_.camera,
                                       shader_.light_of_lamps(ahead[i], met, randoms[i]));
                sums.add(places[i], seen);
            }
            count = 0;
        };
        for (int y = around.y; y < around.y + around.height; ++y)
            for (int x = around.x; x < around.x + around.width; ++x)
                for (int i = 0; i < rays; ++i) {
                    if (cancelled()) return false;
                    SampleStream random(seed_of(x, y) ^ of_features, static_cast<std::uint32_t>(i));
                    places[count] = glm::dvec2(x, y) + random.next();
                    const Sight seen = sight(places[count].x, places[count].y, random);
                    ahead[count] = seen.ray;
                    randoms[count] = seen.random;
                    if (++count == ahead.size()) look();
                }
        look();
        for (int y = tile.y; y < tile.y + tile.height; ++y)
            for (int x = tile.x; x < tile.x + tile.width; ++x)
                features[index_in_window(x, y)] = sums.mean(x, y);
        return true;
    }

    /// trace(), through points of the whole picture.
    bool probe(ImageSize size, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t i = begin; i < end; ++i) {
            if (cancelled()) return false;
            const glm::dvec2 point = glm::fract(static_cast<double>(i + 1) * r2_step);
            Sight seen = sight(point.x * size.width, point.y * size.height);
            ++camera_rays_;
            traversal_.begin_path();
            shader_.radiance(seen.ray, seen.random);
        }
        return true;
    }

    TraceStatistics statistics() const {
        TraceStatistics seen = noise_;
        seen.camera_rays = camera_rays_;
        seen.work = traversal_.work() + shader_.work();
        seen.given_up = traversal_.given_up();
        return seen;
    }

  private:
    /// A ray of a picture and the random numbers of its light, which do nothing where all light is from
    /// points.
    struct Sight {
        Ray ray;
        SampleStream random;
    };

    static constexpr int together = Surfaces::most_together;

    /// A ray near the pixel's middle, as often in each place as the filter weighs it.
    Sight through_filter(int x, int y, SampleStream random) const {
        const glm::dvec2 offset = offset_of(random);
        return sight(x + 0.5 + offset.x, y + 0.5 + offset.y, random);
    }

    static glm::dvec2 offset_of(SampleStream& random) {
        static const PixelFilter filter;
        const glm::dvec2 place = random.next();
        return {filter.offset(place.x), filter.offset(place.y)};
    }

    Sight sight(double x, double y, SampleStream random) const {
        if (!rays_.has_lens()) return {rays_.through(x, y), random};
        const glm::dvec2 place = random.next();
        return {rays_.through(x, y, place), random};
    }

    /// Sight by numbers of the point's own, wherever in the picture.
    Sight sight(double x, double y) const {
        return sight(x, y,
                     SampleStream(CounterRandom::scrambled(std::bit_cast<std::uint64_t>(x)),
                                  static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(y) >> 20)));
    }

    /// Looks through `count` points, neighbours together: sight_of(i) is the i-th, and take(i, light) gets
    /// its light, in order, and says whether to go on. False if it was cancelled.
    template<class SightOf, class Take> bool look(int count, const SightOf& sight_of, const Take& take) {
        std::array<Ray, together> rays;
        std::vector<SampleStream>& randoms = randoms_;
        bool more = true;
        for (int first = 0; first < count && more; first += together) {
            if (cancelled()) return false;
            const int end = std::min(count, first + together);
            randoms.clear();
            for (int i = first; i < end; ++i) {
                const Sight seen = sight_of(i);
                rays[static_cast<std::size_t>(i - first)] = seen.ray;
                randoms.push_back(seen.random);
            }
            shader_.look_ahead(std::span(rays).first(randoms.size()), ahead_);
            for (int i = first; i < end && more; ++i) {
                if (i > first && cancelled()) return false;
                const auto number = static_cast<std::size_t>(i - first);
                ++camera_rays_;
                SurfaceHit met;
                traversal_.begin_path();
                const Rgb rgb =
                    shader_.radiance(rays[number], randoms[number], aovs_ ? &met : nullptr, ahead_, number);
                if (aovs_) seen_ = AovSample(met, rays[number], view_, named_);
                more = take(i, rgb);
            }
        }
        return true;
    }

    bool cancelled() const { return control_.cancelled && control_.cancelled(); }

    /// Index of a pixel of the whole picture.
    std::size_t index_in_window(int x, int y) const {
        return static_cast<std::size_t>(y - window_.y) * static_cast<std::size_t>(window_.width) +
               static_cast<std::size_t>(x - window_.x);
    }

    void set(Image& picture, int x, int y, const Rgb& rgb) const {
        const std::size_t first = 3 * index_in_window(x, y);
        for (int c = 0; c < 3; ++c)
            picture.pixels[first + static_cast<std::size_t>(c)] = static_cast<float>(rgb[c]);
    }

    void set(int x, int y, const AovSum& sum) {
        const std::size_t index = index_in_window(x, y);
        aovs_->pixels[index] = sum.pixel();
        if (named_) aovs_->mattes[index] = sum.mattes();
    }

    /// A block has its middle in the whole picture, however little of it is in the window.
    bool trace_blocks(int block, const Tile& tile, Image& picture) {
        // Two rows and four columns at a time are nearer to each other than eight in a row.
        constexpr int down = 2, across = together / down;
        for (int y = tile.y; y < tile.y + tile.height; y += down * block)
            for (int x = tile.x; x < tile.x + tile.width; x += across * block) {
                std::array<Tile, together> blocks;
                int count = 0;
                for (int top = y; top < std::min(y + down * block, tile.y + tile.height); top += block)
                    for (int left = x; left < std::min(x + across * block, tile.x + tile.width);
                         left += block) {
                        const Tile one{left, top, std::min(block, tile.x + tile.width - left),
                                       std::min(block, tile.y + tile.height - top)};
                        if (common(one, window_).pixels() > 0)
                            blocks[static_cast<std::size_t>(count++)] = one;
                    }
                const auto middle = [&](int i) {
                    const Tile& one = blocks[static_cast<std::size_t>(i)];
                    return sight(one.x + 0.5 * one.width, one.y + 0.5 * one.height);
                };
                if (!look(count, middle, [&](int i, const Rgb& rgb) {
                        show(picture, common(blocks[static_cast<std::size_t>(i)], window_), rgb);
                        return true;
                    }))
                    return false;
            }
        return true;
    }

    /// Sets all pixels to one light.
    void show(Image& picture, const Tile& shown, const Rgb& rgb) {
        AovSum sum;
        sum.add(seen_, 1, 0);
        for (int y = shown.y; y < shown.y + shown.height; ++y)
            for (int x = shown.x; x < shown.x + shown.width; ++x) {
                set(picture, x, y, rgb);
                if (aovs_) set(x, y, sum);
            }
    }

    /// Pixel by pixel, each by itself, so that it depends on its place in the picture alone.
    bool trace_samples(const Sampling& sampling, const Tile& tile, Image& picture) {
        for (int y = tile.y; y < tile.y + tile.height; ++y)
            for (int x = tile.x; x < tile.x + tile.width; ++x) {
                if (!has_samples(sampling, x, y)) continue;
                const std::uint64_t seed = seed_of(x, y);
                const auto stream = [&](int number) {
                    return sampling.denoise ? half_stream(seed, number)
                                            : SampleStream(seed, static_cast<std::uint32_t>(number));
                };
                NoiseMeter fresh;
                NoiseMeter& meter = control_.samples ? (*control_.samples)[index_in_window(x, y)] : fresh;
                const auto is_calm = [&] {
                    return meter.count() > 0 && meter.count() % samples_a_round == 0 &&
                           meter.error_255(film_) < sampling.noise_255;
                };
                AovSum sum;
                bool calm = is_calm();
                const int before = static_cast<int>(meter.count());
                const int more = calm ? 0 : sampling.most_samples - before;
                const auto sample = [&](int i) { return through_filter(x, y, stream(before + i)); };
                const bool whole = look(more, sample, [&](int i, const Rgb& rgb) {
                    meter.add(rgb);
                    if (aovs_) {
                        SampleStream random = stream(before + i);
                        const glm::dvec2 offset = offset_of(random);
                        sum.add(seen_, 1, glm::dot(offset, offset));
                    }
                    calm = is_calm();
                    return !calm;
                });
                if (!whole) return false;
                if (!calm && sampling.noise_255 > 0) ++noise_.noisy_pixels;
                note_noise(meter);
                set(picture, x, y, meter.mean());
                if (aovs_) set(x, y, sum);
            }
        show_neighbours(sampling, tile, picture);
        return true;
    }

    /// With AOVs all have some: nothing but samples can tell what a pixel shows.
    bool has_samples(const Sampling& sampling, int x, int y) const {
        return sampling.sparse == 1 || aovs_ || ((x + y) % 2 == 0 && (sampling.sparse == 2 || x % 2 == 0));
    }

    /// Pixels without samples show those of a neighbour in the tile, until their noise is taken out.
    void show_neighbours(const Sampling& sampling, const Tile& tile, Image& picture) const {
        if (sampling.sparse == 1) return;
        const int right = tile.x + tile.width, below = tile.y + tile.height;
        for (int y = tile.y; y < below; ++y)
            for (int x = tile.x; x < right; ++x) {
                if (has_samples(sampling, x, y)) continue;
                for (const auto& [dx, dy] : {std::pair(-1, 0), {0, -1}, {-1, -1}, {1, 0}, {0, 1}, {1, 1}}) {
                    const int i = x + dx, j = y + dy;
                    if (i < tile.x || i >= right || j < tile.y || j >= below || !has_samples(sampling, i, j))
                        continue;
                    std::copy_n(
                        picture.pixels.begin() + 3 * static_cast<std::ptrdiff_t>(index_in_window(i, j)), 3,
                        picture.pixels.begin() + 3 * static_cast<std::ptrdiff_t>(index_in_window(x, y)));
                    break;
                }
            }
    }

    std::uint64_t seed_of(int x, int y) const {
        return (static_cast<std::uint64_t>(y) << 32 | static_cast<std::uint32_t>(x)) ^ control_.sequence
                                                                                           << 48;
    }

    /// Bits of seeds that no pixel's number sets.
    static constexpr std::uint64_t second_half = 1ull << 31, of_features = 1ull << 30;

    /// Every second sample is of a sequence of its own, so that the halves of a pixel's samples tell its
    /// noise. Their mean has a little more of it.
    static SampleStream half_stream(std::uint64_t seed, int number) {
        const auto index = static_cast<std::uint32_t>(number);
        return {index % 2 == 0 ? seed : seed ^ second_half, index / 2};
    }

    void note_noise(const NoiseMeter& meter) {
        if (meter.count() < 2) return;
        ++noise_.measured_pixels;
        noise_.noise_1024 += static_cast<std::uint64_t>(std::llround(1024 * meter.error_255(film_)));
    }

    /// Row after row of samples, each added to the pixels that it belongs to: those on an edge to both sides.
    bool trace_lattice(int steps, const Tile& tile, Image& picture) {
        const auto width = static_cast<std::size_t>(tile.width);
        sums_.assign(width * static_cast<std::size_t>(tile.height), Rgb(0.0));
        row_.resize(width);
        aov_sums_.assign(aovs_ ? sums_.size() : 0, AovSum());
        const double weight = 1.0 / (4.0 * steps * steps); // of a corner of one cell
        for (int j = 0; j <= tile.height * steps; ++j) {
            if (!trace_row(tile, j, steps)) return false;
            const int below = j / steps;
            const bool edge = j % steps == 0;
            // A cell's upper and lower corners count alike; between two cells of a pixel they count for both.
            if (below < tile.height) add_row(below, (edge ? 1 : 2) * weight);
            if (edge && below > 0) add_row(below - 1, weight);
        }
        for (int y = 0; y < tile.height; ++y)
            for (int x = 0; x < tile.width; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                set(picture, tile.x + x, tile.y + y, sums_[pixel]);
                if (aovs_) set(tile.x + x, tile.y + y, aov_sums_[pixel]);
            }
        return true;
    }

    /// For each pixel the sum over a row of its samples: 1 for those on its edges, 2 for those between.
    bool trace_row(const Tile& tile, int j, int steps) {
        std::fill(row_.begin(), row_.end(), Rgb(0.0));
        const double y = tile.y + static_cast<double>(j) / steps;
        const int count = static_cast<int>(row_.size()) * steps;
        const auto sample = [&](int i) { return sight(tile.x + static_cast<double>(i) / steps, y); };
        return look(count + 1, sample, [&](int i, const Rgb& rgb) {
            if (aovs_) add_seen(tile, {i, j}, steps);
            const auto pixel = static_cast<std::size_t>(i / steps);
            const bool edge = i % steps == 0;
            if (pixel < row_.size()) row_[pixel] += (edge ? 1.0 : 2.0) * rgb;
            if (edge && pixel > 0) row_[pixel - 1] += rgb;
            return true;
        });
    }

    /// Adds what the sample at this place of the lattice has seen to the pixels that it belongs to.
    void add_seen(const Tile& tile, glm::ivec2 place, int steps) {
        const glm::ivec2 first = place / steps, edge(place.x % steps == 0, place.y % steps == 0);
        const double weight = (2 - edge.x) * (2 - edge.y); // the weights of trace_row() and trace_lattice()
        for (int y = std::max(first.y - edge.y, 0); y <= std::min(first.y, tile.height - 1); ++y)
            for (int x = std::max(first.x - edge.x, 0); x <= std::min(first.x, tile.width - 1); ++x) {
                const glm::dvec2 offset =
                    glm::dvec2(place) / static_cast<double>(steps) - glm::dvec2(x, y) - 0.5;
                aov_sums_[static_cast<std::size_t>(y) * row_.size() + static_cast<std::size_t>(x)].add(
                    seen_, weight, glm::dot(offset, offset));
            }
    }

    void add_row(int y, double weight) {
        Rgb* const sums = sums_.data() + static_cast<std::size_t>(y) * row_.size();
        for (std::size_t x = 0; x < row_.size(); ++x)
            sums[x] += weight * row_[x];
    }

    CameraRays rays_;
    Traversal traversal_;
    Shader shader_;
    const Film& film_;
    const View& view_;
    const DetailGraph& cut_;
    const TraceControl& control_;
    Shader::Ahead ahead_;
    std::vector<SampleStream> randoms_; ///< of the sights ahead
    std::uint64_t camera_rays_ = 0;
    TraceStatistics noise_; ///< the fields of noise
    std::vector<Rgb> row_, sums_;
    Tile window_;
    AovPicture* aovs_ = nullptr;         ///< null: none are wanted
    const DetailGraph* named_ = nullptr; ///< null: no mattes are
    AovSample seen_;                     ///< by the last look, if they are
    std::vector<AovSum> aov_sums_;
};

/// Tiles of the whole picture that have pixels in the window.
std::vector<Tile> tiles_of(ImageSize size, int block, const Tile& window) {
    const int side = std::max(1, tile_size / block) * block;
    std::vector<Tile> tiles;
    for (int y = window.y / side * side; y < window.y + window.height; y += side)
        for (int x = window.x / side * side; x < window.x + window.width; x += side)
            tiles.push_back({x, y, std::min(side, size.width - x), std::min(side, size.height - y)});
    return tiles;
}

} // namespace

PictureTracer::PictureTracer(const TraceModel& model, const ShaderLimits& limits)
    : model_(model), limits_(limits) {}

/// Runs task(worker, number) for all numbers, until one says false; then false.
template<class Task>
bool PictureTracer::run(std::uint64_t tasks, const TraceControl& control, const Task& task) {
    const SerialWorkers alone;
    const Workers& threads = control.workers ? *control.workers : static_cast<const Workers&>(alone);
    std::vector<std::unique_ptr<Worker>> workers(static_cast<std::size_t>(threads.count()));
    std::atomic<bool> complete = true;
    model_.meshes.cancel_by(control.for_good);
    threads.for_each(tasks, [&](int thread, std::uint64_t number) {
        if (!complete) return;
        std::unique_ptr<Worker>& worker = workers[static_cast<std::size_t>(thread)];
        if (!worker) worker = std::make_unique<Worker>(model_, limits_, control);
        if (!task(*worker, number)) complete = false;
    });
    for (const std::unique_ptr<Worker>& worker : workers)
        if (worker) statistics_ += worker->statistics();
    model_.meshes.cancel_by({});
    return complete && !control.for_good.raised(); // else some shell may be missing
}

bool PictureTracer::trace(const Sampling& sampling, const TraceControl& control, Image& picture,
                          AovPicture* aovs) {
    return trace(sampling, control, whole_of(model_.view.size), picture, aovs);
}

bool PictureTracer::trace(const Sampling& sampling, const TraceControl& control, const Tile& window,
                          Image& picture, AovPicture* aovs) {
    GRAFTAL_CHECK(window.lies_in(model_.view.size), "trace: a window beyond the picture");
    GRAFTAL_CHECK(picture.channels == 3 && picture.width == window.width && picture.height == window.height,
                  "trace: a picture of another size");
    GRAFTAL_CHECK(!aovs || 3 * aovs->pixels.size() == picture.pixels.size(), "trace: AOVs of another size");
    GRAFTAL_CHECK(!control.samples || 3 * control.samples->size() == picture.pixels.size(),
                  "trace: samples of another size");
    const std::vector<Tile> tiles = tiles_of(model_.view.size, sampling.block, window);
    std::mutex telling;
    return run(tiles.size(), control, [&](Worker& worker, std::uint64_t number) {
        if (!worker.trace(sampling, tiles[number], window, picture, aovs)) return false;
        if (!control.on_tile) return true;
        const std::lock_guard lock(telling);
        control.on_tile(common(tiles[number], window));
        return true;
    });
}

bool PictureTracer::trace_features(int rays, const TraceControl& control, const Tile& window,
                                   std::vector<PixelFeatures>& features) {
    const std::vector<Tile> tiles = tiles_of(model_.view.size, 1, window);
    return run(tiles.size(), control, [&](Worker& worker, std::uint64_t number) {
        return worker.trace_features(rays, common(tiles[number], window), window, features);
    });
}

bool PictureTracer::probe(std::uint64_t begin, std::uint64_t end, const TraceControl& control) {
    return run((end - begin + probe_piece - 1) / probe_piece, control,
               [&](Worker& worker, std::uint64_t number) {
                   const std::uint64_t first = begin + number * probe_piece;
                   return worker.probe(model_.view.size, first, std::min(first + probe_piece, end));
               });
}

} // namespace graftal
