#include "compiler/graph/run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/graph/packed_edges.h"
#include "compiler/support/bounds.h"

namespace graftal {

namespace {

constexpr double units_per_turn = 4294967296.0;

Vec3 unit_along(Vec3 axis) {
    const double length = glm::length(axis);
    return length > 0 ? axis / length : Vec3(0, 1, 0);
}

/// The x axis of the item's parts, of unit length.
Vec3 unit_aside(const RunItem& item, Vec3 y) {
    const Vec3 x = across(y);
    if (item.turn == 0) return x;
    const double angle = item.turn * (2 * std::numbers::pi / units_per_turn);
    return std::cos(angle) * x + std::sin(angle) * glm::cross(x, y);
}

/// Holds the item, and is hardly larger.
Box box_about(const RunItem& item) {
    Box box;
    for (const Vec3& end : {item.base, item.base + item.axis}) {
        box.include(end - Vec3(item.radius));
        box.include(end + Vec3(item.radius));
    }
    return box;
}

double half_area(const Box& box) {
    const Vec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Whether the items lie anyhow in `all`: ranges of them fill far more of it than cubes would that share it.
bool are_scattered(const Run& run, Box& all) {
    constexpr std::size_t items_a_range = 256;
    constexpr double much = 4;
    double sum = 0, ranges = 0;
    for (std::size_t first = 0; first < run.size(); first += items_a_range, ++ranges) {
        Box box;
        for (std::size_t i = first; i < std::min(first + items_a_range, run.size()); ++i)
            box.include(box_about(run[i]));
        sum += half_area(box);
        all.include(box);
    }
    return sum > much * half_area(all) * std::cbrt(ranges);
}

/// The lower 21 bits, each with two bits of 0 above it.
std::uint64_t spread_bits(std::uint64_t bits) {
    bits &= 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}

/// The place of a point of the box along Morton's curve.
std::uint64_t place_on_curve(Vec3 point, const Box& box) {
    constexpr double cells = 2097151; // 2^21 - 1
    const double side = std::max({box.size().x, box.size().y, box.size().z});
    std::uint64_t place = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = (point[axis] - box.min[axis]) / side;
        const auto cell = static_cast<std::uint64_t>(share > 0 ? cells * std::min(share, 1.0) : 0);
        place |= spread_bits(cell) << axis;
    }
    return place;
}

} // namespace

void order_in_space(Run& run) {
    Box all;
    if (!are_scattered(run, all)) return;
    std::vector<std::pair<std::uint64_t, std::size_t>> order(run.size());
    for (std::size_t i = 0; i < run.size(); ++i)
        order[i] = {place_on_curve(run[i].base + 0.5 * run[i].axis, all), i};
    std::ranges::sort(order);
    for (std::size_t first = 0; first < run.size(); ++first) { // one cycle after the other
        const RunItem kept = run[first];
        std::size_t to = first;
        for (;;) {
            const std::size_t from = std::exchange(order[to].second, to);
            if (from == first) break;
            run[to] = run[from];
            to = from;
        }
        run[to] = kept;
    }
}

RunShape::RunShape(const Primitive& primitive)
    : top_steps_(primitive == PrimitiveKind::frustum ? primitive.steps()
                                                     : RunShape(primitive.kind()).top_steps_) {}

Vec3 across(Vec3 unit) {
    const double sign = std::copysign(1.0, unit.z);
    const double a = -1 / (sign + unit.z);
    return {1 + sign * unit.x * unit.x * a, sign * unit.x * unit.y * a, -sign * unit.x};
}

std::uint32_t turn_of(Vec3 axis, Vec3 x) {
    const Vec3 y = unit_along(axis), start = across(y);
    const double turns =
        std::atan2(glm::dot(x, glm::cross(start, y)), glm::dot(x, start)) / (2 * std::numbers::pi);
    const double units = std::round((turns - std::floor(turns)) * units_per_turn);
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(units)); // a full turn is none
}

bool is_sound(const RunItem& item) {
    const double sum = item.base.x + item.base.y + item.base.z + item.axis.x + item.axis.y + item.axis.z;
    return item.shape.is_sound() && std::isfinite(sum) && std::isfinite(item.radius) && item.radius > 0 &&
           item.axis != Vec3(0.0);
}

Affine run_from_body(const RunItem& item) {
    const Vec3 y = unit_along(item.axis), x = unit_aside(item, y);
    return {Mat3(item.radius * x, item.axis, item.radius * glm::cross(x, y)), item.base};
}

Affine run_from_ball(const RunItem& item) {
    const Vec3 y = unit_along(item.axis), x = unit_aside(item, y);
    return {Mat3(item.radius * x, item.radius * y, item.radius * glm::cross(x, y)), item.base + item.axis};
}

Affine run_from_round_body(const RunItem& item) {
    const Vec3 y = unit_along(item.axis), x = across(y);
    return {Mat3(item.radius * x, item.axis, item.radius * glm::cross(x, y)), item.base};
}

Affine run_from_round_ball(const RunItem& item) {
    return {Mat3(item.radius), item.base + item.axis};
}

void Run::grow() {
    auto chunk = std::make_unique_for_overwrite<RunItem[]>(chunk_size);
    const std::size_t used = size_ & (chunk_size - 1);
    if (used > 0) { // the last one was made shorter
        std::copy_n(chunks_.back().get(), used, chunk.get());
        chunks_.pop_back();
    }
    chunks_.push_back(std::move(chunk));
    capacity_ = chunks_.size() * chunk_size;
}

void Run::shrink_to_fit() {
    if (size_ == capacity_) return;
    const std::size_t used = size_ & (chunk_size - 1);
    auto last = std::make_unique<RunItem[]>(used);
    std::copy_n(chunks_.back().get(), used, last.get());
    chunks_.back() = std::move(last);
    capacity_ = size_;
}

std::size_t PackedEdges::size() const {
    return run ? run->part_count() : 0;
}

std::size_t PackedEdges::item_count() const {
    return run ? run->size() : 0;
}

std::optional<MaterialId> PackedEdges::material_of_item(std::size_t item) const {
    return materials[(*run)[item].colour];
}

std::optional<std::size_t> PackedEdges::unsound_item() const {
    for (std::size_t i = 0; i < item_count(); ++i)
        if (!is_sound((*run)[i]) || (*run)[i].colour >= materials.size()) return i;
    return std::nullopt;
}

PackedEdge PackedEdges::Iterator::operator*() const {
    const RunItem& item = (*edges_->run)[item_];
    const std::optional<MaterialId>& material = edges_->materials[item.colour];
    if (at_ball_) return {PrimitiveKind::sphere, run_from_ball(item), material};
    return {item.shape.primitive(), run_from_body(item), material};
}

PackedEdges::Iterator& PackedEdges::Iterator::operator++() {
    at_ball_ = !at_ball_ && (*edges_->run)[item_].ball;
    if (!at_ball_) ++item_;
    return *this;
}

} // namespace graftal
