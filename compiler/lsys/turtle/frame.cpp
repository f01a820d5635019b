#include "compiler/lsys/turtle/frame.h"

#include <bit>

#include <glm/matrix.hpp>

#include "compiler/support/id_table.h"

namespace graftal {

std::uint64_t mixed_number(std::uint64_t hash, double number) {
    return mixed(hash, std::bit_cast<std::uint64_t>(number));
}

std::uint64_t mixed_vector(std::uint64_t hash, const Vec3& v) {
    return mixed_number(mixed_number(mixed_number(hash, v.x), v.y), v.z);
}

TurtleFrame seen_from(const TurtleFrame& frame, const Affine& start_from_turtle, double scale) {
    const Mat3 turtle_from_start = glm::transpose(start_from_turtle.linear);
    TurtleFrame seen = frame;
    seen.axes = turtle_from_start * frame.axes;
    seen.origin = (1 / scale) * (turtle_from_start * (frame.origin - start_from_turtle.translation));
    seen.unit = frame.unit / scale;
    for (Tropism& tropism : seen.tropisms)
        tropism.direction = turtle_from_start * tropism.direction;
    return seen;
}

std::uint64_t hash_of_tropisms(std::uint64_t hash, const TurtleFrame& frame) {
    for (const Tropism& tropism : frame.tropisms)
        if (tropism.elasticity != 0)
            hash = mixed_vector(mixed_number(hash, tropism.elasticity), tropism.direction);
    return hash;
}

std::uint64_t hash_of_axes(std::uint64_t hash, const TurtleFrame& frame) {
    for (int column = 0; column < 3; ++column)
        hash = mixed_vector(hash, frame.axes[column]);
    return hash;
}

std::uint64_t hash_of_origin(std::uint64_t hash, const TurtleFrame& frame) {
    return mixed_number(mixed_vector(hash, frame.origin), frame.unit);
}

bool equal_tropisms(const TurtleFrame& a, const TurtleFrame& b) {
    for (std::size_t i = 0; i < most_other_tropisms; ++i) {
        const Tropism &first = a.tropisms[i], &second = b.tropisms[i];
        if (first.elasticity != second.elasticity) return false;
        if (first.elasticity != 0 && first.direction != second.direction) return false;
    }
    return true;
}

bool equal_places(const TurtleFrame& a, const TurtleFrame& b) {
    return a.origin == b.origin && a.unit == b.unit;
}

} // namespace graftal
