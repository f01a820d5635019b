#include "compiler/povray/literal_form.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr double equal_share = 1e-12;

bool at_right_angles(Vec3 a, Vec3 b) {
    return std::abs(glm::dot(a, b)) <= equal_share * glm::length(a) * glm::length(b);
}

bool equal_lengths(Vec3 a, Vec3 b) {
    return std::abs(glm::length(a) - glm::length(b)) <= equal_share * glm::length(a);
}

bool keeps_right_angles(const Mat3& m) {
    return at_right_angles(m[0], m[1]) && at_right_angles(m[0], m[2]) && at_right_angles(m[1], m[2]);
}

/// A cross-section in the plane of columns 0 and 2 stays a circle, upright on column 1.
bool keeps_round(const Mat3& m) {
    return equal_lengths(m[0], m[2]) && keeps_right_angles(m);
}

/// Each column lies along one axis. A singular map can send two along the same.
bool keeps_axes(const Mat3& m) {
    for (int column = 0; column < 3; ++column) {
        int along = 0;
        for (int row = 0; row < 3; ++row)
            along += m[column][row] != 0;
        if (along != 1) return false;
    }
    return keeps_right_angles(m);
}

} // namespace

bool needs_no_matrix(PrimitiveKind kind, const Mat3& linear) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return true;
    case PrimitiveKind::sphere:
        return keeps_round(linear) && equal_lengths(linear[0], linear[1]);
    case PrimitiveKind::cube:
        return keeps_axes(linear);
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return keeps_round(linear);
    case PrimitiveKind::torus:
    case PrimitiveKind::plane:
        return false;
    }
    return false;
}

} // namespace graftal
