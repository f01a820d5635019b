#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace graftal {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3; ///< column-major, as GLM has it: m[column][row]

/// x -> linear x + translation. Named destination_from_source, so that products read from the right.
struct Affine {
    Mat3 linear{1.0};
    Vec3 translation{0.0};

    Vec3 operator()(Vec3 point) const { return linear * point + translation; }
    bool operator==(const Affine&) const = default;

    static Affine scale(Vec3 factors) {
        return {Mat3(factors.x, 0, 0, 0, factors.y, 0, 0, 0, factors.z), Vec3(0.0)};
    }
    static Affine translate(Vec3 offset) { return {Mat3(1.0), offset}; }
    /// Right-handed rotation about `axis` (need not be of unit length; not zero). Multiples of 90 degrees
    /// about coordinate axes are exact.
    static Affine rotate(Vec3 axis, double angle_deg);
};

/// First b, then a: (a * b)(x) = a(b(x)).
inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, a(b.translation)};
}

/// Requires a non-singular linear part.
Affine inverse(const Affine& a);

/// Singular values of the linear part, largest first (one-sided Jacobi; error about 1e-15 of the largest), at
/// any scale that doubles hold.
Vec3 singular_values(const Mat3& linear);

/// The largest absolute value of the entries.
double largest_entry(const Mat3& matrix);
double largest_entry(Vec3 v);

/// The largest stretch, |A|_2.
double norm(const Mat3& linear);

/// True if all entries are finite.
bool is_finite(const Affine& a);

/// True if the smallest singular value is at most `relative` times the largest, or all are zero.
bool is_singular(const Affine& a, double relative = 1e-12);

} // namespace graftal
