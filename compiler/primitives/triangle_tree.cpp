#include "compiler/primitives/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/jacobi.h"

namespace graftal {

namespace {

constexpr std::uint32_t triangles_a_leaf = 4;
constexpr double infinite = std::numeric_limits<double>::infinity();

Vec3 middle_of(const Triangle& t) {
    return (t[0] + t[1] + t[2]) / 3.0;
}

/// The part of the range in which a ray is between two places along an axis; empty where least > most.
RayRange between(double low, double high, double direction, RayRange range) {
    if (direction == 0) return low > 0 || high < 0 ? RayRange{1, 0} : range;
    const double a = low / direction, b = high / direction;
    return {std::max(range.least, std::min(a, b)), std::min(range.most, std::max(a, b))};
}

double distance2(const Box& box, Vec3 point) {
    const Vec3 out = glm::max(glm::max(box.min - point, point - box.max), Vec3(0.0));
    return glm::dot(out, out);
}

/// The farthest coordinate of the box along the direction.
double reach(const Box& box, Vec3 direction) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += direction[i] * (direction[i] > 0 ? box.max[i] : box.min[i]);
    return sum;
}

double half_area(Vec3 size) {
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
Vec3 closest_point(const Triangle& t, Vec3 point) {
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = point - t[0];
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return t[0];
    const Vec3 bp = point - t[1];
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return t[1];
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + d1 / (d1 - d3) * ab;
    const Vec3 cp = point - t[2];
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return t[2];
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]);
    const double sum = va + vb + vc;
    return t[0] + vb / sum * ab + vc / sum * ac;
}

} // namespace

/// Moments of the corners about the root's middle.
struct TriangleTree::Spread {
    double count = 0;
    Vec3 sum{0.0};
    Mat3 squares{0.0}; ///< sum of outer products

    void add(const Spread& other) {
        count += other.count;
        sum += other.sum;
        squares += other.squares;
    }
};

TriangleTree::TriangleTree(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (const Triangle& triangle : triangles_)
        for (const Vec3& corner : triangle)
            extent_ = std::max({extent_, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(order_.size()));
    constexpr std::size_t most_in_caches = 100'000; // triangles; a million took twice the time for a step
    step_weight_ = triangles_.size() > most_in_caches ? 2 : 1;
}

/// Halves by the middles along the longest side: as deep as the logarithm of the count.
TriangleTree::Spread TriangleTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t end) {
    Box box, middles;
    for (std::uint32_t i = first; i < end; ++i) {
        for (const Vec3& corner : triangles_[order_[i]])
            box.include(corner);
        middles.include(middle_of(triangles_[order_[i]]));
    }
    nodes_[node].box = box;
    Spread spread;
    if (end - first <= triangles_a_leaf) {
        nodes_[node].first = first;
        nodes_[node].count = end - first;
        const Vec3 middle = nodes_.front().box.centre();
        for (std::uint32_t i = first; i < end; ++i)
            for (const Vec3& corner : triangles_[order_[i]]) {
                const Vec3 from = corner - middle;
                spread.add({1, from, glm::outerProduct(from, from)});
            }
    } else {
        const Vec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t half = first + (end - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double x = middle_of(triangles_[a])[axis],
                                          y = middle_of(triangles_[b])[axis];
                             return x != y ? x < y : a < b;
                         });
        const auto children = static_cast<std::uint32_t>(nodes_.size());
        nodes_[node].first = children;
        nodes_.resize(nodes_.size() + 2);
        spread = split(children, first, half);
        spread.add(split(children + 1, half, end));
    }
    add_slabs(node, first, end, spread);
    return spread;
}

/// Across the two directions in which the corners spread least, where that leaves much less than the box.
void TriangleTree::add_slabs(std::uint32_t number, std::uint32_t first, std::uint32_t end,
                             const Spread& spread) {
    constexpr double much_less = 0.25;    // of the box's area
    constexpr double much_thinner = 0.05; // than the box's thinnest side
    constexpr std::uint32_t many = 64;    // triangles may lie one behind the other
    const Vec3 size = nodes_[number].box.size();
    const auto is_worth = [&](Vec3 turned) {
        return half_area(turned) < much_less * half_area(size) ||
               (end - first >= many &&
                std::min({turned.x, turned.y, turned.z}) < much_thinner * std::min({size.x, size.y, size.z}));
    };
    const Vec3 mean = spread.sum / spread.count;
    Mat3 columns = spread.squares / spread.count - glm::outerProduct(mean, mean);
    const double trace = columns[0][0] + columns[1][1] + columns[2][2];
    if (!(trace > 0)) return;
    columns /= trace;
    Mat3 axes(1.0);
    make_columns_orthogonal(columns, &axes);
    std::array<int, 3> order{0, 1, 2};
    Vec3 variance;
    for (int i = 0; i < 3; ++i)
        variance[i] = glm::length(columns[i]);
    std::ranges::sort(order, [&](int a, int b) { return variance[a] < variance[b]; });
    // The sides of an even spread: most nodes need no closer look.
    if (!is_worth(glm::sqrt(12 * trace * variance))) return;
    std::array<Slab, 3> slabs;
    Vec3 turned;
    for (int i = 0; i < 3; ++i) {
        Slab& slab = slabs[static_cast<std::size_t>(i)];
        slab = {glm::normalize(axes[order[static_cast<std::size_t>(i)]]), infinite, -infinite};
        for (std::uint32_t k = first; k < end; ++k)
            for (const Vec3& corner : triangles_[order_[k]]) {
                const double at = glm::dot(slab.across, corner);
                slab.least = std::min(slab.least, at);
                slab.most = std::max(slab.most, at);
            }
        turned[i] = slab.most - slab.least;
    }
    if (!is_worth(turned)) return;
    nodes_[number].slabs = static_cast<std::uint32_t>(slabs_.size());
    slabs_.insert(slabs_.end(), slabs.begin(), slabs.begin() + 2);
}

RayRange TriangleTree::within(const Node& node, const Ray& ray, double slack, RayRange range) const {
    for (int axis = 0; axis < 3; ++axis)
        range = between(node.box.min[axis] - slack - ray.origin[axis],
                        node.box.max[axis] + slack - ray.origin[axis], ray.direction[axis], range);
    if (node.slabs == no_slabs || !(range.least <= range.most)) return range;
    for (std::uint32_t i = node.slabs; i < node.slabs + 2; ++i) {
        const Slab& slab = slabs_[i];
        const double at = glm::dot(slab.across, ray.origin);
        range = between(slab.least - slack - at, slab.most + slack - at, glm::dot(slab.across, ray.direction),
                        range);
    }
    return range;
}

/// No more than that of anything in the node.
double TriangleTree::distance2(const Node& node, Vec3 point) const {
    double least = graftal::distance2(node.box, point);
    if (node.slabs == no_slabs) return least;
    for (std::uint32_t i = node.slabs; i < node.slabs + 2; ++i) {
        const double at = glm::dot(slabs_[i].across, point);
        const double out = std::max({slabs_[i].least - at, at - slabs_[i].most, 0.0});
        least = std::max(least, out * out);
    }
    return least;
}

bool TriangleTree::meet(const Ray& ray, const RayRange& range, TriangleHit& hit, std::uint32_t& triangle,
                        std::uint64_t& steps, std::uint64_t most_steps) const {
    const TriangleRay triangle_ray(ray, extent_);
    const double far =
        extent_ + std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)});
    // Seams, and the rounding of a product with a slab's direction.
    const double slack = 2 * TriangleRay::seam * far;
    const double tie = one_depth * far / glm::length(ray.direction);
    RayRange left = range;
    bool met = false;
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        steps += step_weight_;
        const RayRange inside = within(node, ray, slack, left);
        if (!(inside.least <= inside.most)) continue;
        if (steps >= most_steps) {
            if (met) break;
            hit = {inside.least, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
            triangle = first_below(node);
            return true;
        }
        if (node.count == 0) {
            const std::uint32_t near = node.first, far_child = node.first + 1;
            const bool turned =
                glm::dot(nodes_[far_child].box.centre() - nodes_[near].box.centre(), ray.direction) < 0;
            stack[size++] = turned ? near : far_child;
            stack[size++] = turned ? far_child : near;
            continue;
        }
        steps += step_weight_ * node.count;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (TriangleHit at; triangle_ray.meet(triangles_[order_[i]], left, at)) {
                left.most = std::max(at.t - tie, left.least);
                hit = at;
                triangle = order_[i];
                met = true;
            }
    }
    return met;
}

double TriangleTree::reach(Vec3 direction) const {
    constexpr int levels = 4;
    return reach(nodes_.front(), direction, levels);
}

double TriangleTree::reach(const Node& node, Vec3 direction, int levels) const {
    if (node.count > 0 || levels == 0) return graftal::reach(node.box, direction);
    return std::max(reach(nodes_[node.first], direction, levels - 1),
                    reach(nodes_[node.first + 1], direction, levels - 1));
}

std::uint32_t TriangleTree::first_below(const Node& node) const {
    const Node* at = &node;
    while (at->count == 0)
        at = &nodes_[at->first];
    return order_[at->first];
}

Vec3 TriangleTree::farthest(Vec3 direction) const {
    double most = -infinite;
    Vec3 best = triangles_.front()[0];
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        if (!(graftal::reach(node.box, direction) > most)) continue;
        if (node.count == 0) {
            const bool first = graftal::reach(nodes_[node.first].box, direction) >=
                               graftal::reach(nodes_[node.first + 1].box, direction);
            stack[size++] = first ? node.first + 1 : node.first;
            stack[size++] = first ? node.first : node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            for (const Vec3& corner : triangles_[order_[i]])
                if (const double at = glm::dot(corner, direction); at > most) {
                    most = at;
                    best = corner;
                }
    }
    return best;
}

std::uint32_t TriangleTree::nearest(Vec3 point) const {
    // On a triangle up to rounding: of many that coincide one is enough.
    const double near_enough = 1e-28 * glm::dot(point, point);
    double least = infinite;
    std::uint32_t best = 0;
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0 && least > near_enough) {
        const Node& node = nodes_[stack[--size]];
        if (!(distance2(node, point) < least)) continue;
        if (node.count == 0) {
            const bool first =
                distance2(nodes_[node.first], point) <= distance2(nodes_[node.first + 1], point);
            stack[size++] = first ? node.first + 1 : node.first;
            stack[size++] = first ? node.first : node.first + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Vec3 away = closest_point(triangles_[order_[i]], point) - point;
            if (const double square = glm::dot(away, away); square < least) {
                least = square;
                best = order_[i];
            }
        }
    }
    return best;
}

std::vector<std::vector<std::uint32_t>> TriangleTree::parts(std::size_t most) const {
    std::vector<std::uint32_t> level = {0};
    for (bool grows = true; grows && 2 * level.size() <= most;) {
        std::vector<std::uint32_t> next;
        grows = false;
        for (const std::uint32_t number : level) {
            const Node& node = nodes_[number];
            if (node.count > 0) {
                next.push_back(number);
                continue;
            }
            grows = true;
            next.push_back(node.first);
            next.push_back(node.first + 1);
        }
        level = std::move(next);
    }
    std::vector<std::vector<std::uint32_t>> parts;
    for (const std::uint32_t number : level) {
        std::vector<std::uint32_t> stack = {number}, part;
        while (!stack.empty()) {
            const Node& node = nodes_[stack.back()];
            stack.pop_back();
            if (node.count == 0) {
                stack.insert(stack.end(), {node.first, node.first + 1});
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                part.push_back(order_[i]);
        }
        parts.push_back(std::move(part));
    }
    return parts;
}

} // namespace graftal
