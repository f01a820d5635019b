#include "compiler/graph/run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/graph/packed_edges.h"

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

} // namespace

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
