#include "runtime/trace/model/box_tree.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace graftal {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
/// Compares false with all: an empty box would be turned inside out by the signs of a ray.
constexpr float no_box = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t width = 8;
constexpr int bins = 16;
/// Deeper than this, halves by number take the place of the heuristic.
constexpr int deepest_by_area = 32;
/// The flag is asked before so many items are split: some milliseconds.
constexpr std::size_t items_a_look = 4096;

struct FloatBox {
    std::array<float, 3> lower{infinite, infinite, infinite};
    std::array<float, 3> upper{-infinite, -infinite, -infinite};

    void include(const std::array<float, 3>& low, const std::array<float, 3>& high) {
        for (std::size_t i = 0; i < 3; ++i) {
            lower[i] = std::min(lower[i], low[i]);
            upper[i] = std::max(upper[i], high[i]);
        }
    }
    double half_area() const {
        if (!(lower[0] <= upper[0])) return 0;
        const double x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
        return x * y + y * z + z * x;
    }
};

using Items = std::span<BoxedItem>;

FloatBox box_of(Items items) {
    FloatBox box;
    for (const BoxedItem& item : items)
        box.include(item.lower, item.upper);
    return box;
}

/// Half of the middle: a finite one, and so is the difference of two, where a box has no end in a float.
float half_middle(const BoxedItem& item, std::size_t axis) {
    constexpr float most = std::numeric_limits<float>::max();
    return 0.25f * std::max(item.lower[axis], -most) + 0.25f * std::min(item.upper[axis], most);
}

/// The size of a first part nearest to the one wanted: a multiple of `grain`, neither nothing nor all.
std::size_t in_grains(std::size_t size, std::size_t all, std::size_t grain) {
    const std::size_t most = (all - 1) / grain * grain;
    return std::clamp((size + grain / 2) / grain * grain, grain, most);
}

struct Split {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t axis = 0;
    int bin = 0; ///< the first of the second half
};

/// Sorts middles into bins between the least and the greatest along an axis.
struct Bins {
    float least = 0, scale = 0;

    Bins(float low, float high) : least(low), scale(bins / (high - low)) {}
    int operator()(float value) const {
        return std::clamp(static_cast<int>((value - least) * scale), 0, bins - 1);
    }
};

Split best_split(Items items, const FloatBox& middles) {
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Bins bin_of(middles.lower[axis], middles.upper[axis]);
        if (!(middles.upper[axis] > middles.lower[axis]) || !std::isfinite(bin_of.scale)) continue;
        std::array<FloatBox, bins> box;
        std::array<double, bins> count{};
        for (const BoxedItem& item : items) {
            const auto bin = static_cast<std::size_t>(bin_of(half_middle(item, axis)));
            box[bin].include(item.lower, item.upper);
            ++count[bin];
        }
        std::array<double, bins> right_cost{};
        FloatBox right;
        double right_count = 0;
        for (std::size_t bin = bins - 1; bin > 0; --bin) {
            right.include(box[bin].lower, box[bin].upper);
            right_count += count[bin];
            right_cost[bin] = right_count > 0 ? right_count * right.half_area() : infinite;
        }
        FloatBox left;
        double left_count = 0;
        for (std::size_t bin = 1; bin < bins; ++bin) {
            left.include(box[bin - 1].lower, box[bin - 1].upper);
            left_count += count[bin - 1];
            const double cost = left_count > 0 ? left_count * left.half_area() + right_cost[bin] : infinite;
            if (cost < best.cost) best = {cost, axis, static_cast<int>(bin)};
        }
    }
    return best;
}

/// Splits more than `grain` items into two parts that are not empty, the first of a multiple of `grain`;
/// returns its size.
std::size_t split(Items items, int depth, std::size_t grain) {
    FloatBox middles;
    for (const BoxedItem& item : items) {
        const std::array<float, 3> point{half_middle(item, 0), half_middle(item, 1), half_middle(item, 2)};
        middles.include(point, point);
    }
    if (depth < deepest_by_area) {
        const Split best = best_split(items, middles);
        if (best.cost < infinite) {
            const Bins bin_of(middles.lower[best.axis], middles.upper[best.axis]);
            const auto part = std::partition(items.begin(), items.end(), [&](const BoxedItem& item) {
                return bin_of(half_middle(item, best.axis)) < best.bin;
            });
            const auto size = static_cast<std::size_t>(part - items.begin());
            const std::size_t whole = in_grains(size, items.size(), grain);
            if (whole == size) return size;
            std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(whole), {},
                                     [&](const BoxedItem& item) { return half_middle(item, best.axis); });
            return whole;
        }
    }
    return in_grains(items.size() / 2, items.size(), grain); // in one place, or too deep: take any halves
}

class TreeBuilder {
  public:
    /// `packed`: takes the items, unless it is null.
    TreeBuilder(const CancelFlag& cancel, std::vector<BoxNode>& nodes,
                std::vector<PackedNode>* packed = nullptr)
        : cancel_(cancel), nodes_(nodes), packed_(packed) {}

    std::uint32_t build(Items items, int depth) {
        struct Part {
            Items items;
            double area;
        };
        std::vector<Part> parts = {{items, infinite}};
        int levels = 0;
        // Where items are packed, nodes below are full.
        std::size_t grain = packed_ ? width : 1;
        while (packed_ && grain * width < items.size())
            grain *= width;
        while (parts.size() < width) {
            // The largest that can be split: it is the likeliest to be met.
            auto largest = parts.end();
            for (auto part = parts.begin(); part != parts.end(); ++part)
                if (part->items.size() > grain && (largest == parts.end() || part->area > largest->area))
                    largest = part;
            if (largest == parts.end()) break;
            const Items whole = largest->items;
            if (whole.size() > items_a_look && cancel_.raised()) throw Cancelled();
            const std::size_t first = split(whole, depth + levels++ / 3, grain);
            *largest = {whole.first(first), box_of(whole.first(first)).half_area()};
            parts.push_back({whole.subspan(first), box_of(whole.subspan(first)).half_area()});
        }
        const auto number = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(empty_node());
        for (std::size_t lane = 0; lane < parts.size(); ++lane) {
            const Items part = parts[lane].items;
            const std::uint32_t entry = entry_of(part, depth);
            const FloatBox box = box_of(part);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                nodes_[number].side[0][axis][lane] = box.lower[axis];
                nodes_[number].side[1][axis][lane] = box.upper[axis];
            }
            nodes_[number].entry[lane] = entry;
        }
        return number;
    }

    std::uint32_t pack(Items items) {
        PackedNode node;
        const FloatBox box = box_of(items);
        node.count = static_cast<std::uint8_t>(items.size());
        node.first = std::ranges::min(items, {}, &BoxedItem::item).item;
        for (std::size_t lane = 0; lane < width; ++lane)
            node.offset[lane] =
                static_cast<std::uint8_t>(items[std::min(lane, items.size() - 1)].item - node.first);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.origin[axis] = box.lower[axis];
            node.step[axis] = step_between(box.lower[axis], box.upper[axis]);
            for (std::size_t lane = 0; lane < width; ++lane) {
                const BoxedItem& item = items[std::min(lane, items.size() - 1)];
                node.side[0][axis][lane] = byte_below(node, axis, item.lower[axis]);
                node.side[1][axis][lane] = byte_above(node, axis, item.upper[axis]);
            }
        }
        packed_->push_back(node);
        return static_cast<std::uint32_t>(packed_->size() - 1) | BoxNode::packed;
    }

  private:
    std::uint32_t entry_of(Items part, int depth) {
        if (packed_ && part.size() <= width) return pack(part) | BoxNode::inner;
        return part.size() == 1 ? part.front().item : build(part, depth + 3) | BoxNode::inner;
    }

    /// The least step by which the last byte lies beyond the upper end, as it is computed.
    static float step_between(float lower, float upper) {
        float step = (upper - lower) / last_byte;
        while (lower + last_byte * step < upper)
            step = std::nextafter(step, infinite);
        return step;
    }

    static std::uint8_t byte_below(const PackedNode& node, std::size_t axis, float value) {
        if (!(node.step[axis] > 0)) return 0;
        float byte = std::clamp(std::floor((value - node.origin[axis]) / node.step[axis]), 0.0f, last_byte);
        while (byte > 0 && node.origin[axis] + byte * node.step[axis] > value)
            --byte;
        return static_cast<std::uint8_t>(byte);
    }

    static std::uint8_t byte_above(const PackedNode& node, std::size_t axis, float value) {
        if (!(node.step[axis] > 0)) return 0;
        float byte = std::clamp(std::ceil((value - node.origin[axis]) / node.step[axis]), 0.0f, last_byte);
        while (byte < last_byte && node.origin[axis] + byte * node.step[axis] < value)
            ++byte;
        return static_cast<std::uint8_t>(byte);
    }

    static BoxNode empty_node() {
        BoxNode node{};
        for (int axis = 0; axis < 3; ++axis)
            for (std::size_t lane = 0; lane < width; ++lane) {
                node.side[0][axis][lane] = no_box;
                node.side[1][axis][lane] = no_box;
            }
        return node;
    }

    static constexpr float last_byte = 255;

    const CancelFlag& cancel_;
    std::vector<BoxNode>& nodes_;
    std::vector<PackedNode>* packed_;
};

} // namespace

BoxedItem::BoxedItem(const Box& box, std::uint32_t number) : item(number) {
    constexpr double slack = 4e-6;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        lower[i] = std::nextafter(static_cast<float>(box.min[axis] - slack), -infinite);
        upper[i] = std::nextafter(static_cast<float>(box.max[axis] + slack), infinite);
    }
}

std::uint32_t build_box_tree(std::vector<BoxedItem>& items, std::vector<BoxNode>& nodes,
                             const CancelFlag& cancel) {
    return items.empty() ? no_tree : TreeBuilder(cancel, nodes).build(items, 0);
}

std::uint32_t build_packed_tree(std::vector<BoxedItem>& items, std::vector<BoxNode>& nodes,
                                std::vector<PackedNode>& packed, const CancelFlag& cancel) {
    if (items.empty()) return no_tree;
    TreeBuilder builder(cancel, nodes, &packed);
    return items.size() <= width ? builder.pack(items) : builder.build(items, 0);
}

} // namespace graftal
