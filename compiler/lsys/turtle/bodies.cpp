#include "compiler/lsys/turtle/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/lsys/turtle/flat_model.h"
#include "compiler/lsys/turtle/polygon_outline.h"
#include "compiler/lsys/turtle/skin.h"
#include "compiler/lsys/turtle/triangulate.h"
#include "compiler/primitives/limb_sweep.h"
#include "compiler/primitives/polygon_rings.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// The thickness of a disc, per diameter.
constexpr double disc_thickness = 1e-3;

/// Pairs of a polygon's corners that are held against each other in the time of an instance.
constexpr std::size_t pairs_an_instance = 128;

/// Places the canonical triangle on three corners.
Affine on_corners(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 centre = (a + b + c) / 3.0;
    const Vec3 x = (c - b) / std::numbers::sqrt3, y = a - centre;
    const double size = std::max(largest_entry(x), largest_entry(y));
    constexpr double largest = 1e50; // squares of areas are numbers up to here
    const double unit = size > largest || size < 1 / largest ? size : 1;
    const Vec3 normal = glm::cross(x / unit, y / unit);
    return {Mat3(x, y, unit * (normal / std::sqrt(glm::length(normal)))), centre};
}

/// A round piece, without its ends.
DrawnBody frustum(double length, double from_width, double width) {
    const double slant = std::hypot(length, (from_width - width) / 2);
    const double squares = from_width * from_width + from_width * width + width * width;
    return {.organ = Organ::segment,
            .length = length,
            .width = width,
            .base_width = from_width,
            .area = std::numbers::pi * (from_width + width) / 2 * slant,
            .volume = std::numbers::pi / 12 * length * squares};
}

DrawnBody ball(double diameter) {
    const double area = std::numbers::pi * diameter * diameter;
    return {.organ = Organ::ball, .width = diameter, .area = area, .volume = area * diameter / 6};
}

DrawnBody disc(double diameter) {
    return {.organ = Organ::disc, .width = diameter, .area = std::numbers::pi * diameter * diameter / 4};
}

} // namespace

void TurtleBodies::tell(DrawnBody body, int colour) const {
    body.material = palette_[static_cast<std::size_t>(colour)].name;
    witness_->draws(body);
}

void TurtleBodies::widen_packed(double factor) {
    for (std::size_t i = 0; i < packed_count(); ++i) {
        RunItem& item = (*run_)[i];
        if (!(item.colour & open_width)) continue;
        item.colour &= static_cast<std::uint16_t>(~open_width);
        item.radius *= factor;
    }
}

PackedEdges TurtleBodies::take_packed() {
    if (packed_count() == 0) return {};
    order_in_space(*run_);
    run_->shrink_to_fit();
    return {std::move(run_), ids_};
}

int TurtleBodies::colour_index(double number) const {
    const auto size = static_cast<double>(palette_.size());
    const double index = std::fmod(number, size);
    return static_cast<int>(index < 0 ? index + size : index);
}

MaterialId TurtleBodies::material(int colour) {
    const auto index = static_cast<std::size_t>(colour);
    if (ids_[index]) return *ids_[index];
    const auto known = std::ranges::find(graph_.materials, palette_[index].name, &Material::name);
    ids_[index] = static_cast<MaterialId>(known - graph_.materials.begin());
    if (known == graph_.materials.end()) graph_.materials.push_back(palette_[index]);
    return *ids_[index];
}

Instance TurtleBodies::body(const Primitive& primitive, const Affine& place, int colour, Span span) {
    const auto [known, added] = primitives_.try_emplace(primitive);
    if (added) known->second = graph_.primitive(primitive);
    return {known->second, place, Tint(), material(colour), span};
}

/// `x`: of unit length, where the body's x axis points.
void TurtleBodies::add_item(RunShape shape, Vec3 base, Vec3 axis, double radius, Vec3 x, bool ball,
                            int colour, const BodySink& sink) {
    const auto index = static_cast<std::size_t>(colour);
    material(colour);
    RunItem item{base, axis, std::abs(radius), 0, shape, ball, static_cast<std::uint16_t>(index)};
    if (!is_sound(item)) return; // too small for numbers
    if (!palette_[index].texture.empty()) item.turn = turn_of(axis, x);
    if (sink.open_width) item.colour |= open_width;
    run_->add(item);
}

void TurtleBodies::add_segment(const Affine& start_from_turtle, double length, double width, int colour,
                               Span span, BodySink sink) {
    if (witness_) return tell(frustum(std::abs(length), width, width), colour);
    if (length == 0 || width == 0) return;
    const double radius = width / 2;
    if (run_) {
        add_item(PrimitiveKind::cylinder, start_from_turtle.translation, length * start_from_turtle.linear[1],
                 radius, start_from_turtle.linear[0], true, colour, sink);
        return;
    }
    add(PrimitiveKind::cylinder, start_from_turtle * Affine::scale({radius, length, radius}), colour, span,
        sink);
    const Affine end = start_from_turtle * Affine::translate({0, length, 0});
    add(PrimitiveKind::sphere, end * Affine::scale(Vec3(radius)), colour, span, sink);
}

void TurtleBodies::add_taper(const Affine& start_from_turtle, Vec3 from, double from_width, double width,
                             int colour, Span span, BodySink sink) {
    Vec3 thick = from, thin = start_from_turtle.translation;
    if (width > from_width) std::swap(thick, thin);
    const Vec3 y = thin - thick;
    const double length = glm::length(y), radius = std::max(width, from_width) / 2;
    if (witness_) {
        DrawnBody body = frustum(length, from_width, width);
        body.start = from;
        return tell(body, colour);
    }
    if (!(length > 0) || !(radius > 0)) return;
    // Round it may face anywhere: as the turtle does, so that equal pieces stay equal.
    Vec3 x = start_from_turtle.linear[0] - glm::dot(start_from_turtle.linear[0], y) / (length * length) * y;
    if (glm::length(x) < 1e-3)
        x = start_from_turtle.linear[2] - glm::dot(start_from_turtle.linear[2], y) / (length * length) * y;
    x = glm::normalize(x);
    if (run_) {
        add_item(tapered(std::min(width, from_width) / (2 * radius)), thick, y, radius, x, false, colour,
                 sink);
        add_sphere(start_from_turtle, width, colour, span, sink);
        return;
    }
    const Mat3 linear(radius * x, y, radius * glm::cross(x, y / length));
    add(tapered(std::min(width, from_width) / (2 * radius)), {linear, thick}, colour, span, sink);
    add_sphere(start_from_turtle, width, colour, span, sink);
}

void TurtleBodies::find_shapes() {
    for (; known_shapes_ < graph_.objects.size(); ++known_shapes_) {
        const Object& object = graph_.objects[known_shapes_];
        if (!object.primitive) continue;
        const bool is_limb = *object.primitive == PrimitiveKind::limb_sweep;
        if (!is_limb && *object.primitive != PrimitiveKind::polygon) continue;
        if (!shapes_.emplace(object.name, known_shapes_).second) continue;
        if (is_limb)
            skin_triangles_ += limb_triangles(*object.primitive);
        else
            picture_corners_ += rings_of(*object.primitive).corners.size();
    }
}

std::optional<ObjectId> TurtleBodies::shape(PrimitiveKind kind, std::span<const double> numbers) {
    find_shapes();
    const std::string name = shape_name(kind, numbers);
    if (const auto known = shapes_.find(name); known != shapes_.end()) return known->second;
    std::string fault;
    Object object;
    object.name = name;
    object.primitive = traits_of(kind).make(numbers, fault);
    if (!object.primitive) return std::nullopt;
    graph_.add(std::move(object));
    find_shapes();
    return shapes_.at(name);
}

void TurtleBodies::add_limb(const Limb& limb, int sides, BodySink sink) {
    const std::optional<LimbSkin> skin = skin_of(limb, sides);
    if (!skin || skin_triangles_ > most_skin_triangles) return;
    const std::optional<ObjectId> made = shape(PrimitiveKind::limb_sweep, skin->numbers);
    if (!made) return; // too thin for numbers
    sink.instances.push_back({*made, skin->start_from_skin, Tint(), material(limb.colour), limb.span});
}

std::optional<Instance> TurtleBodies::line(Vec3 end, int colour, Span span) {
    const double length = glm::length(end);
    if (!(length > 0)) return std::nullopt;
    const Vec3 y = end / length;
    const Vec3 aside = std::abs(y.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    const Vec3 x = glm::normalize(glm::cross(y, aside));
    const double radius = 0.5 * length;
    return body(PrimitiveKind::cylinder, {Mat3(radius * x, end, radius * glm::cross(x, y)), Vec3(0.0)},
                colour, span);
}

void TurtleBodies::add_sphere(const Affine& start_from_turtle, double diameter, int colour, Span span,
                              BodySink sink) {
    diameter = at_least_size(diameter);
    if (witness_) return tell(ball(std::abs(diameter)), colour);
    if (diameter == 0) return;
    if (run_) {
        const double radius = std::abs(diameter) / 2;
        add_item(PrimitiveKind::sphere, start_from_turtle.translation, radius * start_from_turtle.linear[1],
                 radius, start_from_turtle.linear[0], false, colour, sink);
        return;
    }
    add(PrimitiveKind::sphere, start_from_turtle * Affine::scale(Vec3(diameter / 2)), colour, span, sink);
}

void TurtleBodies::add_disc(const Affine& start_from_turtle, double diameter, int colour, Span span,
                            BodySink sink) {
    diameter = at_least_size(diameter);
    if (witness_) return tell(disc(std::abs(diameter)), colour);
    if (diameter == 0) return;
    const Affine upright = start_from_turtle * Affine::rotate({1, 0, 0}, 90);
    const double thickness = disc_thickness * diameter;
    if (run_) {
        const Vec3 axis = std::abs(thickness) * upright.linear[1];
        add_item(PrimitiveKind::cylinder, upright.translation - 0.5 * axis, axis, diameter / 2,
                 upright.linear[0], false, colour, sink);
        return;
    }
    add(PrimitiveKind::cylinder,
        upright * Affine::translate({0, -thickness / 2, 0}) *
            Affine::scale({diameter / 2, thickness, diameter / 2}),
        colour, span, sink);
}

bool TurtleBodies::add_outline(std::span<const Vec3> corners, const Mat3& axes, int colour, Span span,
                               BodySink sink) {
    if (picture_corners_ > most_picture_corners) return false;
    const std::optional<PolygonOutline> outline = outline_of(corners, axes);
    if (!outline || !is_finite(outline->start_from_outline)) return false;
    const std::optional<ObjectId> made = shape(PrimitiveKind::polygon, outline->numbers);
    if (!made) return false; // it meets itself
    sink.instances.push_back({*made, outline->start_from_outline, Tint(), material(colour), span});
    return true;
}

bool TurtleBodies::add_polygon(std::span<const Vec3> corners, const Mat3& axes, int colour, Span span,
                               BodySink sink) {
    polygon_work_ += corners.size() * corners.size() / pairs_an_instance;
    if (witness_) {
        std::vector<PlantTriangle> triangles;
        DrawnBody body{.organ = Organ::polygon};
        for (const auto& [a, b, c] : triangulate(corners)) {
            triangles.push_back({corners[a], corners[b], corners[c]});
            body.area += glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a])) / 2;
        }
        body.triangles = triangles;
        tell(body, colour);
        return true;
    }
    const bool is_pictured = !palette_[static_cast<std::size_t>(colour)].texture.empty();
    if (is_pictured && add_outline(corners, axes, colour, span, sink)) return true;
    const std::vector<std::array<std::uint32_t, 3>> triangles = triangulate(corners);
    for (const auto& [a, b, c] : triangles) {
        const Affine place = on_corners(corners[a], corners[b], corners[c]);
        if (is_finite(place)) add(PrimitiveKind::triangle, place, colour, span, sink);
    }
    const bool splits = is_pictured && triangles.size() > 1 && !split_a_picture_;
    split_a_picture_ = split_a_picture_ || splits;
    return !splits;
}

void TurtleBodies::add_model(const PlacedModel& model, const Affine& start_from_turtle, Span span,
                             BodySink sink) {
    if (witness_) {
        const std::optional<double> area = flat_area(graph_, model.root, Affine::scale(model.scale).linear);
        return witness_->draws({.organ = Organ::model,
                                .area = area.value_or(0),
                                .is_measured = area.has_value(),
                                .graph = &graph_,
                                .model = model.root,
                                .part_from_model = start_from_turtle * Affine::scale(model.scale)});
    }
    const Vec3 scale(at_least_size(model.scale.x), at_least_size(model.scale.y),
                     at_least_size(model.scale.z));
    if (scale.x == 0 || scale.y == 0) return;
    sink.instances.push_back(
        {model.root, start_from_turtle * Affine::scale(scale), Tint(), std::nullopt, span});
}

} // namespace graftal
