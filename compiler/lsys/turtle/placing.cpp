#include "compiler/lsys/turtle/turtle.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

// The part of the turtle that places parts composed already.

namespace graftal {

void Turtle::append(const TurtlePart& part, Span span, const Placing& given) {
    append_branch(part, span, given);
    const Placing placing = in_frame(given);
    const double scale = placing.scale;
    const double length = scale * glm::length(part.start_from_exit.translation);
    const double stir = 1 + sensitivity_.turn; // of the part's directions
    const double unit_shift = placing.unit_error * part.unit_sensitivity.exit_shift;
    const double shift = part.error.exit_shift + placing.snap * part.sensitivity.exit_shift + unit_shift;
    const double turn = error_.turn + part.error.exit_turn + placing.snap * part.sensitivity.exit_turn;
    way_ += scale * part.exit_way;
    size_shift_ += scale * (part.size_error.exit_shift + unit_shift);
    error_ = {std::min(turn, farthest_directions),
              std::min(error_.at(length) + scale * shift, farthest_directions * way_ + size_shift_)};
    sensitivity_ = {bounded(sensitivity_.turn + stir * part.sensitivity.exit_turn),
                    bounded(sensitivity_.at(length) + stir * scale * part.sensitivity.exit_shift)};
    unit_shift_ += placing.absolute ? length : scale * part.unit_sensitivity.exit_shift;
    if (part.writes & reads_width) take_exit_width(part, placing);
    if (part.writes & reads_colour) state_.colour = part.exit.colour;
    if (part.writes & reads_limb) state_.limb_radius = scale * part.exit.limb_radius;
    if (part.writes & reads_elasticity) state_.elasticity = part.exit.elasticity;
    if (part.writes & reads_cylinder) state_.in_cylinder = part.exit.in_cylinder;
    if (part.writes & reads_control) {
        state_.control_point = start_from_turtle_(scale * part.exit.control_point);
        state_.control_width = scale * part.exit.control_width;
    }
    if (part.writes & reads_reversal) state_.turns_reversed = part.exit.turns_reversed;
    if (part.writes & reads_ruler) state_.ruler = scale_ * part.exit.ruler; // its frame is of the scale alone
    if (part.writes & reads_angle) state_.angle_factor = part.exit.angle_factor;
    if (part.writes & reads_tropisms) take_tropisms(*part.exit.frame);
    writes_ |= part.writes;
    const Affine& exit = part.start_from_exit;
    start_from_turtle_ = start_from_turtle_ * Affine{exit.linear, scale * exit.translation};
    scale_ *= part.exit_scale;
    mirrored_ = mirrored_ != part.mirrors;
    if (part.writes & reads_second)
        second_ = start_from_turtle_.linear * glm::mat3_cast(part.exit.second);
    else if (part.mirrors)
        second_[0] = -second_[0];
    if (part.cut) cut();
}

/// The elasticities; the directions are those of this turtle.
void Turtle::take_tropisms(const TurtleFrame& exit) {
    TurtleFrame frame = *state_.frame;
    for (std::size_t i = 0; i < most_other_tropisms; ++i)
        frame.tropisms[i].elasticity = exit.tropisms[i].elasticity;
    state_.frame = std::make_shared<TurtleFrame>(frame);
}

void Turtle::take_exit_width(const TurtlePart& part, const Placing& placing) {
    state_.width = (context_.relative_width ? 1 : placing.scale) * part.exit.width;
    switch (part.exit_width_source) {
    case WidthSource::start:
        width_error_ += placing.width_error + part.exit_width_error;
        return;
    case WidthSource::unit:
        width_source_ = WidthSource::unit;
        width_error_ = placing.unit_error + part.exit_width_error;
        return;
    case WidthSource::sizes:
        width_source_ = placing.absolute ? WidthSource::unit : WidthSource::sizes;
        width_error_ = placing.size_error + part.exit_width_error;
        return;
    }
}

/// Each kind of displacement is bounded by itself, and the bounds are added.
void Turtle::place_errors(const TurtlePart& part, const Placing& placing) {
    const double scale = placing.scale, reach = scale * part.reach;
    const double of_sizes = (width_error_ + placing.width_error) * part.width_sensitivity +
                            placing.unit_error * part.unit_sensitivity.farthest +
                            placing.size_error * part.thickest;
    const double own = part.error.farthest + placing.snap * part.sensitivity.farthest + of_sizes;
    const double all_sizes = size_shift_ + scale * (part.size_error.farthest + of_sizes);
    const double way = way_ + scale * part.longest_way;
    part_.size_error.farthest = std::max(part_.size_error.farthest, all_sizes);
    part_.error.farthest = std::max(part_.error.farthest, std::min(error_.at(reach) + scale * own,
                                                                   farthest_directions * way + all_sizes));
    part_.longest_way = std::max(part_.longest_way, way);
    part_.sensitivity.farthest = std::max(
        part_.sensitivity.farthest,
        bounded(sensitivity_.at(reach) + (1 + sensitivity_.turn) * scale * part.sensitivity.farthest));
    double by_unit =
        placing.absolute ? reach + scale * part.thickest : scale * part.unit_sensitivity.farthest;
    const double by_width = scale * part.width_sensitivity;
    if (width_source_ == WidthSource::start)
        part_.width_sensitivity = std::max(part_.width_sensitivity, by_width);
    if (width_source_ == WidthSource::unit || placing.absolute) by_unit += by_width;
    part_.unit_sensitivity.farthest = std::max(part_.unit_sensitivity.farthest, unit_shift_ + by_unit);
    part_.thickest = std::max(part_.thickest, scale * part.thickest);
}

void Turtle::append_branch(const TurtlePart& part, Span span, const Placing& given) {
    const Placing placing = in_frame(given);
    place_errors(part, placing);
    TurtleStateMask reads = part.reads;
    // Whether polygons are open outside of this part does not matter where enough were opened inside.
    if (polygons_.size() > part.polygon_ends.size())
        reads &= static_cast<TurtleStateMask>(~(reads_polygons | reads_polygon_count));
    if (placing.absolute) reads |= reads_unit;
    note(reads);
    const double scale = placing.scale;
    for (const Instance& instance : part.instances) {
        part_.instances.push_back(instance);
        const Affine& place = instance.parent_from_child;
        part_.instances.back().parent_from_child =
            start_from_turtle_ * Affine{scale * place.linear, scale * place.translation};
    }
    append_polygons(part, scale, span);
    if (context_.skin > 0) append_limbs(part, scale, span);
    part_.reach = std::max(part_.reach, glm::length(start_from_turtle_.translation) + scale * part.reach);
    part_.has_bodies = part_.has_bodies || part.has_bodies;
    if (context_.tallies) part_.lengths.add(part.lengths, scale);
    part_.modules += part.modules;
    part_.segments += part.segments;
    part_.bodies += part.bodies;
}

/// Polygons may begin in one part and end in another, as branches do not.
void Turtle::append_polygons(const TurtlePart& part, double scale, Span span) {
    const auto record = [&](const std::vector<Vec3>& vertices) {
        for (const Vec3& vertex : vertices)
            record_vertex(start_from_turtle_(scale * vertex));
    };
    for (const TurtlePart::PolygonEnd& end : part.polygon_ends) {
        record(end.vertices);
        close_polygon(end.colour, span);
    }
    record(part.vertices);
    for (const TurtlePart::OpenPolygon& polygon : part.polygons) {
        polygons_.push_back({start_from_turtle_.linear * polygon.axes, {}});
        record(polygon.vertices);
    }
}

} // namespace graftal
