#include "compiler/primitives/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr std::uint32_t triangles_a_leaf = 4;

Vec3 middle_of(const Triangle& t) {
    return (t[0] + t[1] + t[2]) / 3.0;
}

/// The part of the range within the box; empty where least > most. Slabs of no thickness count.
RayRange within(const Box& box, const Ray& ray, RayRange range) {
    const double slack = 1e-12 * glm::length(box.size());
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] - slack - ray.origin[axis],
                     high = box.max[axis] + slack - ray.origin[axis];
        if (ray.direction[axis] == 0) {
            if (low > 0 || high < 0) return {1, 0};
            continue;
        }
        const double a = low / ray.direction[axis], b = high / ray.direction[axis];
        range.least = std::max(range.least, std::min(a, b));
        range.most = std::min(range.most, std::max(a, b));
    }
    return range;
}

bool meet_triangle(const Triangle& triangle, const Ray& ray, const RayRange& range, double& t) {
    // Edges of neighbours leave no gap.
    constexpr double slack = 1e-12;
    const Vec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
    const Vec3 p = glm::cross(ray.direction, ac);
    const double determinant = glm::dot(ab, p);
    const double size = glm::length(ab) * glm::length(ac) * glm::length(ray.direction);
    if (!(std::abs(determinant) > 1e-15 * size)) return false;
    const Vec3 from = ray.origin - triangle[0];
    const double u = glm::dot(from, p) / determinant;
    const Vec3 q = glm::cross(from, ab);
    const double v = glm::dot(ray.direction, q) / determinant;
    if (!(u >= -slack && v >= -slack && u + v <= 1 + slack)) return false;
    t = glm::dot(ac, q) / determinant;
    return t > range.least && t < range.most;
}

double distance2(const Box& box, Vec3 point) {
    const Vec3 out = glm::max(glm::max(box.min - point, point - box.max), Vec3(0.0));
    return glm::dot(out, out);
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

TriangleTree::TriangleTree(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(order_.size()));
}

/// Halves by the middles along the longest side: as deep as the logarithm of the count.
void TriangleTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t end) {
    Box box, middles;
    for (std::uint32_t i = first; i < end; ++i) {
        for (const Vec3& corner : triangles_[order_[i]])
            box.include(corner);
        middles.include(middle_of(triangles_[order_[i]]));
    }
    nodes_[node].box = box;
    if (end - first <= triangles_a_leaf) {
        nodes_[node].first = first;
        nodes_[node].count = end - first;
        return;
    }
    const Vec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = middle_of(triangles_[a])[axis], y = middle_of(triangles_[b])[axis];
                         return x != y ? x < y : a < b;
                     });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = children;
    nodes_.resize(nodes_.size() + 2);
    split(children, first, half);
    split(children + 1, half, end);
}

bool TriangleTree::meet(const Ray& ray, const RayRange& range, double& t, std::uint32_t& triangle) const {
    RayRange left = range;
    bool met = false;
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        if (const RayRange inside = within(node.box, ray, left); !(inside.least <= inside.most)) continue;
        if (node.count == 0) {
            const std::uint32_t near = node.first, far = node.first + 1;
            const bool turned =
                glm::dot(nodes_[far].box.centre() - nodes_[near].box.centre(), ray.direction) < 0;
            stack[size++] = turned ? near : far;
            stack[size++] = turned ? far : near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (double at = 0; meet_triangle(triangles_[order_[i]], ray, left, at)) {
                left.most = t = at;
                triangle = order_[i];
                met = true;
            }
    }
    return met;
}

Vec3 TriangleTree::farthest(Vec3 direction) const {
    const auto reach = [&](const Box& box) {
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            sum += direction[i] * (direction[i] > 0 ? box.max[i] : box.min[i]);
        return sum;
    };
    double most = -std::numeric_limits<double>::infinity();
    Vec3 best = triangles_.front()[0];
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        if (!(reach(node.box) > most)) continue;
        if (node.count == 0) {
            const bool first = reach(nodes_[node.first].box) >= reach(nodes_[node.first + 1].box);
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
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = 0;
    std::array<std::uint32_t, 64> stack{};
    std::size_t size = 1;
    while (size > 0) {
        const Node& node = nodes_[stack[--size]];
        if (!(distance2(node.box, point) < least)) continue;
        if (node.count == 0) {
            const bool first =
                distance2(nodes_[node.first].box, point) <= distance2(nodes_[node.first + 1].box, point);
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
