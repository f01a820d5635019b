#include "runtime/gpu/flat_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "runtime/gpu/flat_model.h"
#include "runtime/gpu/flat_words.h"

namespace graftal {

namespace {

constexpr std::size_t most_children = 4;

double half_area(const Box& box) {
    if (box.empty()) return 0;
    const Vec3 size = box.max - box.min;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

struct Group {
    std::span<FlatItem> items;
    Box box;
};

Group group_of(std::span<FlatItem> items) {
    Group group{items, {}};
    for (const FlatItem& item : items)
        group.box.include(item.box);
    return group;
}

void sort_along(int axis, std::span<FlatItem> items) {
    std::ranges::sort(items, {}, [axis](const FlatItem& item) {
        return std::pair(item.box.min[axis] + item.box.max[axis], item.entry);
    });
}

std::array<Group, 2> halves_of(const Group& group) {
    const std::size_t half = group.items.size() / 2;
    return {group_of(group.items.first(half)), group_of(group.items.subspan(half))};
}

/// So many items are halved where they lie: to look for the best place would take longer than it saves.
constexpr std::size_t most_sorted = 1 << 14;

/// The two parts of a group for which rays are tested least.
std::array<Group, 2> split(const Group& group) {
    const std::span<FlatItem> items = group.items;
    if (items.size() > most_sorted) {
        const Vec3 size = group.box.size();
        sort_along(size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2, items);
        return halves_of(group);
    }
    std::vector<double> rest(items.size() + 1);
    double least = std::numeric_limits<double>::infinity();
    std::size_t place = items.size() / 2;
    int best_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(axis, items);
        Box box;
        for (std::size_t i = items.size() - 1; i > 0; --i) {
            box.include(items[i].box);
            rest[i] = half_area(box) * static_cast<double>(items.size() - i);
        }
        box = Box();
        for (std::size_t i = 1; i < items.size(); ++i) {
            box.include(items[i - 1].box);
            const double cost = half_area(box) * static_cast<double>(i) + rest[i];
            if (!(cost < least)) continue;
            least = cost;
            place = i;
            best_axis = axis;
        }
    }
    if (best_axis != 2) sort_along(best_axis, items);
    return {group_of(items.first(place)), group_of(items.subspan(place))};
}

class Builder {
  public:
    explicit Builder(std::vector<glm::vec4>& boxes) : boxes_(boxes) {}

    std::uint32_t build(std::span<FlatItem> items, int depth) {
        std::vector<Group> groups = {group_of(items)};
        while (groups.size() < most_children) {
            const auto larger = [](const Group& a, const Group& b) {
                return (a.items.size() > 1 ? half_area(a.box) + 1e-300 : 0) <
                       (b.items.size() > 1 ? half_area(b.box) + 1e-300 : 0);
            };
            const auto largest = std::ranges::max_element(groups, larger);
            if (largest->items.size() < 2) break;
            // Coincident items make lopsided trees: halves end after the logarithm of their number.
            const auto [first, second] = depth < most_depth ? split(*largest) : halves_of(*largest);
            *largest = first;
            groups.push_back(second);
        }
        const std::size_t node = add_node();
        for (std::size_t i = 0; i < groups.size(); ++i)
            set_child(node, i,
                      {groups[i].box, groups[i].items.size() == 1 ? groups[i].items[0].entry
                                                                  : build(groups[i].items, depth + 1)});
        return static_cast<std::uint32_t>(node);
    }

    /// Puts items without an end before a tree, if there is one.
    std::uint32_t put_before(std::span<const FlatItem> endless, std::uint32_t tree) {
        while (!endless.empty()) {
            const std::size_t node = add_node(), count = std::min(endless.size(), most_children - 1);
            for (std::size_t i = 0; i < count; ++i)
                set_child(node, i, endless[i]);
            if (tree != NONE) set_child(node, count, {endless[0].box, tree});
            endless = endless.subspan(count);
            tree = static_cast<std::uint32_t>(node);
        }
        return tree;
    }

  private:
    static constexpr int most_depth = 40;

    std::size_t add_node() {
        for (std::size_t i = 0; i < most_children; ++i) {
            boxes_.emplace_back(1, 1, 1, flat_bits(NONE));
            boxes_.emplace_back(-1, -1, -1, 0);
        }
        return boxes_.size() / BOX_SIZE - 1;
    }

    void set_child(std::size_t node, std::size_t number, const FlatItem& child) {
        const std::size_t at = node * BOX_SIZE + 2 * number;
        boxes_[at] = corner(child.box.min, -1, child.entry);
        boxes_[at + 1] = corner(child.box.max, 1, 0);
    }

    static glm::vec4 corner(Vec3 at, double side, std::uint32_t word) {
        constexpr double rounding = 2e-6, least_size = 0.05;
        glm::vec4 result(0, 0, 0, flat_bits(word));
        for (int i = 0; i < 3; ++i)
            result[i] = static_cast<float>(at[i] + side * rounding * std::max(std::abs(at[i]), least_size));
        return result;
    }

    std::vector<glm::vec4>& boxes_;
};

} // namespace

std::uint32_t build_flat_boxes(std::vector<FlatItem>& items, std::vector<glm::vec4>& boxes) {
    std::erase_if(items, [](const FlatItem& item) { return item.box.empty(); });
    const auto bounded =
        std::ranges::partition(items, [](const FlatItem& item) { return item.box.max.x < flat_endless; });
    const std::span<FlatItem> endless(bounded), others(items.begin(), bounded.begin());
    if (items.size() == 1) return items[0].entry;
    Builder builder(boxes);
    return builder.put_before(endless, others.empty() ? NONE : builder.build(others, 0));
}

} // namespace graftal
