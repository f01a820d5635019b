#include "runtime/inverse/blocks/encode.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "runtime/inverse/blocks/decode.h"

namespace graftal {

namespace {

constexpr int cells = 4, features = cells * cells; ///< of a block: the means of 4 by 4 cells
constexpr int ranges_a_job = 8;
constexpr Eigen::Index domains_at_once = 1024;
constexpr std::size_t candidates = 8;
constexpr int best_pool_bits = 12; ///< more do not pay for their addresses

/// Bits of a block, about, as the file has them: of one that is flat, and of one with a domain besides its
/// address.
constexpr double flat_bits = 7, map_bits = 15, division_bits = 1;
/// The weight of a chroma's squared errors. Those of red, green and blue together grow by 3.5 of them, for a
/// chroma is that of four pixels; but eyes see luma better.
constexpr double chroma_weight = 2;
/// Seconds of one processor.
constexpr double product_price = 6e-9; ///< of a range in one isometry and a domain
constexpr double pixel_price = 4e-9;   ///< of a candidate
constexpr double measuring_rounds = 30;

/// A map, and its squared error over the block.
struct Match {
    BlockMap map;
    double error = 0;
};

/// Sums over the pixels of a block.
struct BlockSums {
    double levels = 0, squares = 0;
};

/// The mean of each pixel and its neighbours to the right and below.
LevelPlane averages(const LevelPlane& plane) {
    LevelPlane means(std::max(plane.width - 1, 0), std::max(plane.height - 1, 0));
    for (int y = 0; y < means.height; ++y)
        for (int x = 0; x < means.width; ++x)
            means.levels[means.index(x, y)] =
                (plane.at(x, y) + plane.at(x + 1, y) + plane.at(x, y + 1) + plane.at(x + 1, y + 1)) / 4;
    return means;
}

/// A square of every `stride`-th pixel of a plane.
struct BlockView {
    const LevelPlane* plane;
    int x, y, side, stride;

    float at(int u, int v) const { return plane->at(x + stride * u, y + stride * v); }

    BlockSums sums() const {
        BlockSums sums;
        for (int v = 0; v < side; ++v)
            for (int u = 0; u < side; ++u) {
                sums.levels += at(u, v);
                sums.squares += double{at(u, v)} * at(u, v);
            }
        return sums;
    }

    /// The sums of the cells, less the mean: products of two such are those of the blocks, blurred.
    std::array<float, features> cell_sums(const BlockSums& sums) const {
        std::array<float, features> values{};
        const int width = side / cells;
        for (int v = 0; v < side; ++v)
            for (int u = 0; u < side; ++u) {
                const int cell = v / width * cells + u / width;
                values[static_cast<std::size_t>(cell)] += at(u, v);
            }
        for (float& value : values)
            value = (value - static_cast<float>(sums.levels / features)) / static_cast<float>(width);
        return values;
    }
};

/// The domains of one size, ready to be compared.
class DomainTable {
  public:
    DomainTable(const LevelPlane& means, const PlaneGrid& grid, int side, int bits)
        : side_(side), pool_(grid, side, bits), means_(&means), rows_(pool_.count(), features),
          steepest_(pool_.count()), sums_(pool_.count()) {
        for (std::uint32_t i = 0; i < pool_.count(); ++i) {
            const BlockView block = view(i);
            sums_[i] = block.sums();
            const double pixels = side * side;
            const double deviation =
                std::sqrt(std::max(0.0, sums_[i].squares - sums_[i].levels * sums_[i].levels / pixels));
            const float inverse = deviation > 1e-3 ? static_cast<float>(1 / deviation) : 0;
            const auto values = block.cell_sums(sums_[i]);
            for (int k = 0; k < features; ++k)
                rows_(i, k) = inverse * values[static_cast<std::size_t>(k)];
            steepest_[i] = static_cast<float>(deviation * largest_slope / slope_steps);
        }
    }

    const DomainPool& pool() const { return pool_; }
    const BlockSums& sums(std::uint32_t domain) const { return sums_[domain]; }
    BlockView view(std::uint32_t domain) const {
        return {means_, pool_.x(domain), pool_.y(domain), side_, 2};
    }

    /// The gain of each domain (row) for each column of cell sums: the squared deviation that it explains,
    /// with a slope of the largest size at most.
    Eigen::ArrayXXf gains(Eigen::Index first, Eigen::Index count, const Eigen::MatrixXf& columns) const {
        const Eigen::ArrayXXf products = (rows_.middleRows(first, count) * columns).array().abs();
        return products.square() - (products.colwise() - steepest_.segment(first, count)).max(0.0f).square();
    }

  private:
    int side_;
    DomainPool pool_;
    const LevelPlane* means_;
    Eigen::MatrixXf rows_;
    Eigen::ArrayXf steepest_; ///< product at which the slope is largest
    std::vector<BlockSums> sums_;
};

/// The best domains of a range so far, the best one first.
class Shortlist {
  public:
    float least() const { return entries_.back().gain; }
    void add(float gain, std::uint32_t domain, int isometry) {
        entries_.back() = {gain, domain, isometry};
        for (std::size_t i = candidates - 1; i > 0 && entries_[i].gain > entries_[i - 1].gain; --i)
            std::swap(entries_[i], entries_[i - 1]);
    }
    template<typename Visit> void for_each(const Visit& visit) const {
        for (const Entry& entry : entries_)
            if (entry.gain > 0) visit(entry.domain, entry.isometry);
    }

  private:
    struct Entry {
        float gain = 0;
        std::uint32_t domain = 0;
        int isometry = 0;
    };
    std::array<Entry, candidates> entries_{};
};

Match flat_match(const BlockView& range, const BlockSums& sums) {
    const double pixels = range.side * range.side, mean = sums.levels / pixels;
    Match match{
        {range.x, range.y, range.side, 0, 0, 0, static_cast<int>(std::lround(std::clamp(mean, 0.0, 255.0)))},
        0};
    const double level = match.map.level;
    match.error = sums.squares - 2 * level * sums.levels + pixels * level * level;
    return match;
}

/// The best slope and level, as they are stored, for a domain. A slope of 0 stands for none.
Match map_match(const BlockView& range, const BlockSums& of_range, const DomainTable& table,
                std::uint32_t domain, int isometry) {
    const BlockView block = table.view(domain);
    const BlockSums& of_domain = table.sums(domain);
    const double pixels = range.side * range.side;
    double products = 0;
    for (int v = 0; v < range.side; ++v)
        for (int u = 0; u < range.side; ++u) {
            const auto place = BlockPlace<int>{u, v}.under(isometry, range.side - 1);
            products += double{range.at(u, v)} * block.at(place.u, place.v);
        }
    const double covariance = products - of_range.levels * of_domain.levels / pixels;
    const double variance = of_domain.squares - of_domain.levels * of_domain.levels / pixels;
    const long slope = std::lround(slope_steps * covariance / variance);
    Match match{{range.x, range.y, range.side, 0, isometry, domain, 0}, 0};
    match.map.slope = static_cast<int>(std::clamp<long>(slope, -largest_slope, largest_slope));
    const double s = match.map.scale();
    const double level = (of_range.levels - s * of_domain.levels) / pixels + s * middle_level;
    const long steps = std::lround((level - lowest_level) / level_step);
    match.map.level =
        lowest_level + level_step * static_cast<int>(std::clamp<long>(steps, 0, level_count - 1));
    const double o = match.map.offset();
    match.error = of_range.squares + s * s * of_domain.squares + pixels * o * o +
                  2 * (s * o * of_domain.levels - s * products - o * of_range.levels);
    return match;
}

/// All blocks of one side in a plane: the best map of each.
struct BlockLayer {
    int side, columns, rows; ///< of blocks within the margin
    DomainTable table;
    std::vector<Match> matches;

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    int jobs_a_row() const { return (columns + ranges_a_job - 1) / ranges_a_job; }
    std::uint64_t jobs() const {
        return static_cast<std::uint64_t>(jobs_a_row()) * static_cast<std::uint64_t>(rows);
    }
};

class PlaneSearch {
  public:
    PlaneSearch(const LevelPlane& plane, const PlaneGrid& grid, int bits, double lambda)
        : grid_(grid), bits_(bits), lambda_(lambda),
          plane_(with_margin(plane, grid.padded_width(), grid.padded_height())), means_(averages(plane_)) {
        for (int side = least_side; side <= largest_side; side *= 2) {
            const int columns = plane_.width / side, rows = plane_.height / side;
            layers_.push_back({side, columns, rows, DomainTable(means_, grid, side, bits), {}});
            layers_.back().matches.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        }
    }
    PlaneSearch(const PlaneSearch&) = delete;
    PlaneSearch& operator=(const PlaneSearch&) = delete;

    std::vector<BlockLayer>& layers() { return layers_; }

    /// Finds the maps of some ranges that lie side by side.
    void match_ranges(BlockLayer& layer, std::uint64_t job) const {
        const auto in_row = static_cast<std::uint64_t>(layer.jobs_a_row());
        const int row = static_cast<int>(job / in_row), first = static_cast<int>(job % in_row) * ranges_a_job;
        const int count = std::min(ranges_a_job, layer.columns - first);
        std::array<BlockSums, ranges_a_job> sums;
        Eigen::MatrixXf columns(features, count * isometries);
        const auto range = [&](int i) {
            return BlockView{&plane_, (first + i) * layer.side, row * layer.side, layer.side, 1};
        };
        for (int i = 0; i < count; ++i) {
            sums[static_cast<std::size_t>(i)] = range(i).sums();
            const auto values = range(i).cell_sums(sums[static_cast<std::size_t>(i)]);
            for (int isometry = 0; isometry < isometries; ++isometry)
                for (int k = 0; k < features; ++k) {
                    const auto place = BlockPlace<int>{k % cells, k / cells}.under(isometry, cells - 1);
                    columns(place.v * cells + place.u, i * isometries + isometry) =
                        values[static_cast<std::size_t>(k)];
                }
        }
        const std::array<Shortlist, ranges_a_job> lists = shortlists(layer.table, columns);
        for (int i = 0; i < count; ++i) {
            const BlockSums& of_range = sums[static_cast<std::size_t>(i)];
            Match best = flat_match(range(i), of_range);
            lists[static_cast<std::size_t>(i)].for_each([&](std::uint32_t domain, int isometry) {
                const Match match = map_match(range(i), of_range, layer.table, domain, isometry);
                if (match.map.slope != 0 && cost(layer, match) < cost(layer, best)) best = match;
            });
            layer.matches[layer.index(first + i, row)] = best;
        }
    }

    CodedPlane settle() const {
        CodedPlane plane{grid_, bits_, {}};
        for (int y = 0; y < grid_.height; y += largest_side)
            for (int x = 0; x < grid_.width; x += largest_side)
                settle(range_sides - 1, x, y, plane.blocks);
        return plane;
    }

  private:
    static std::array<Shortlist, ranges_a_job> shortlists(const DomainTable& table,
                                                          const Eigen::MatrixXf& columns) {
        std::array<Shortlist, ranges_a_job> lists;
        const auto domains = static_cast<Eigen::Index>(table.pool().count());
        for (Eigen::Index first = 0; first < domains; first += domains_at_once) {
            const Eigen::ArrayXXf gains =
                table.gains(first, std::min(domains_at_once, domains - first), columns);
            for (Eigen::Index column = 0; column < gains.cols(); ++column) {
                Shortlist& list = lists[static_cast<std::size_t>(column / isometries)];
                if (!(gains.col(column).maxCoeff() > list.least())) continue;
                for (Eigen::Index i = 0; i < gains.rows(); ++i)
                    if (gains(i, column) > list.least())
                        list.add(gains(i, column), static_cast<std::uint32_t>(first + i),
                                 static_cast<int>(column % isometries));
            }
        }
        return lists;
    }

    double cost(const BlockLayer& layer, const Match& match) const {
        const double bits =
            match.map.slope == 0 ? flat_bits : map_bits + std::log2(layer.table.pool().count());
        return match.error + lambda_ * bits;
    }

    /// Appends the cheaper of a square's block and its quarters; returns what it costs.
    double settle(int depth, int x, int y, std::vector<BlockMap>& blocks) const {
        const BlockLayer& layer = layers_[static_cast<std::size_t>(depth)];
        if (x >= grid_.width || y >= grid_.height) return 0;
        const auto own = [&]() -> const Match& {
            return layer.matches[layer.index(x / layer.side, y / layer.side)];
        };
        const bool whole = grid_.holds(x, y, layer.side);
        if (depth == 0) {
            blocks.push_back(own().map);
            return cost(layer, own());
        }
        const std::size_t before = blocks.size();
        double divided = whole ? lambda_ * division_bits : 0;
        for (int quarter = 0; quarter < 4; ++quarter)
            divided +=
                settle(depth - 1, x + quarter % 2 * layer.side / 2, y + quarter / 2 * layer.side / 2, blocks);
        if (!whole || cost(layer, own()) > divided) return divided;
        blocks.resize(before);
        blocks.push_back(own().map);
        return cost(layer, own());
    }

    PlaneGrid grid_;
    int bits_;
    double lambda_;
    LevelPlane plane_, means_;
    std::vector<BlockLayer> layers_; ///< by side, the least first
};

/// Work of all ranges of one side in a plane.
double layer_seconds(const PlaneGrid& grid, int side, int bits) {
    const double ranges = std::floor(grid.padded_width() / side) * std::floor(grid.padded_height() / side);
    const double domains = DomainPool(grid, side, bits).count();
    return ranges * (domains * isometries * product_price +
                     static_cast<double>(candidates * static_cast<std::size_t>(side * side)) * pixel_price);
}

/// Work of the search, and of decoding the luma to say how good it is.
double search_seconds(const BlockPicture& picture, int bits) {
    double seconds =
        measuring_rounds * static_cast<double>(picture.width) * picture.height / decoded_pixels_a_second;
    for (std::size_t i = 0; i < picture.plane_count(); ++i)
        for (int side = least_side; side <= largest_side; side *= 2)
            seconds += layer_seconds(picture.grid_of(i), side, bits);
    return seconds;
}

} // namespace

BlocksFound find_blocks(const PicturePlanes& picture, const BlockCoding& coding, const Workers& workers,
                        const CancelFlag& cancel, const std::function<void(double)>& on_progress) {
    BlocksFound found;
    BlockPicture& blocks = found.picture;
    blocks.width = picture.width;
    blocks.height = picture.height;
    blocks.colour = picture.colour;
    blocks.alpha = picture.alpha;
    int bits = best_pool_bits;
    while (bits > 0 && search_seconds(blocks, bits) > coding.seconds)
        --bits;
    found.seconds = search_seconds(blocks, bits);
    if (found.seconds > coding.seconds) throw OutOfWork("block coding", coding.seconds);
    const double lambda = coding.tolerance * coding.tolerance;
    double done = 0;
    for (std::size_t i = 0; i < picture.planes.size(); ++i) {
        const double weight = blocks.is_half(i) ? chroma_weight : 1;
        PlaneSearch search(picture.planes[i], blocks.grid_of(i), bits, lambda / weight);
        for (BlockLayer& layer : search.layers()) {
            const double seconds = layer_seconds(blocks.grid_of(i), layer.side, bits);
            std::atomic<std::uint64_t> jobs_done = 0;
            workers.for_each(layer.jobs(), [&](int worker, std::uint64_t job) {
                if (cancel.raised()) throw Cancelled();
                search.match_ranges(layer, job);
                const double share = static_cast<double>(++jobs_done) / static_cast<double>(layer.jobs());
                if (worker == 0 && on_progress) on_progress((done + share * seconds) / found.seconds);
            });
            done += seconds;
        }
        blocks.planes.push_back(search.settle());
    }
    return found;
}

} // namespace graftal
