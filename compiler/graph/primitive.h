#pragma once

// A primitive: a kind, and what the kind leaves open. Files in compiler/primitives, one for each kind, tell
// what primitives look like.

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace graftal {

// The kinds by the names that `.inst` uses. Canonical sizes (Hart 1992, section 2; those that the paper
// leaves open are ours):
//   triangle  corners (0,1,0), (-sqrt(3)/2,-1/2,0), (sqrt(3)/2,-1/2,0): the gasket's hull, in the plane z = 0
//   sphere    radius 1 about the origin
//   cube      [-1,1]^3
//   plane     y = 0, unbounded
//   cylinder  radius 1 about the y axis, 0 <= y <= 1, capped
//   cone      base radius 1 at y = 0, apex at y = 1, capped
//   torus     about the y axis, radii 1 and 1/4
//   frustum   between a cylinder and a cone: radius 1 at y = 0, a smaller one at y = 1, capped. Frusta are
//             not affine images of each other. Their upper radius is a multiple of 1/128
//   superellipsoid  (e, n): (|x|^(2/e) + |z|^(2/e))^(e/n) + |y|^(2/n) <= 1, in [-1,1]^3
//   polygon   (x1, y1, x2, y2, ...): outlines in the plane z = 0; points in an odd number of them are filled
//   bicubic_patch  (x, y, z of 16 points): the bicubic Bezier surface of four rows of control points
//   sphere_sweep  (x, y, z, r, ...): what a ball of varying radius sweeps along a smooth curve
//   limb_sweep  (sides, collar, depth, x, y, z, r, ...): the skin of a limb about a chain of points
//   mesh      ("file"): triangles, where the file has them
// Each has a form, which says what makes a primitive of it.
#define GRAFTAL_PRIMITIVE_KINDS(KIND)                                                                        \
    KIND(triangle, plain)                                                                                    \
    KIND(sphere, plain)                                                                                      \
    KIND(cube, plain)                                                                                        \
    KIND(plane, plain)                                                                                       \
    KIND(cylinder, plain)                                                                                    \
    KIND(cone, plain)                                                                                        \
    KIND(torus, plain)                                                                                       \
    KIND(frustum, stepped)                                                                                   \
    KIND(superellipsoid, shaped)                                                                             \
    KIND(polygon, shaped)                                                                                    \
    KIND(bicubic_patch, shaped)                                                                              \
    KIND(sphere_sweep, shaped)                                                                               \
    KIND(limb_sweep, shaped)                                                                                 \
    KIND(mesh, shaped)

enum class PrimitiveForm : std::uint8_t {
    plain,   ///< the kind alone
    stepped, ///< a whole number, which stands for one
    shaped,  ///< a Shape
};

enum class PrimitiveKind : std::uint8_t {
#define GRAFTAL_ENUMERATOR(name, form) name,
    GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_ENUMERATOR)
#undef GRAFTAL_ENUMERATOR
};

inline constexpr std::array all_primitive_kinds = {
#define GRAFTAL_ENTRY(name, form) PrimitiveKind::name,
    GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_ENTRY)
#undef GRAFTAL_ENTRY
};
inline constexpr std::size_t primitive_kind_count = all_primitive_kinds.size();

/// The upper radii of frusta are multiples of 1 / frustum_steps.
inline constexpr int frustum_steps = 128;

/// The data of a primitive where two bytes do not say it: control points, outlines, triangles. Immutable,
/// and shared by all primitives that name it. Its name says all of it, so that equal names are equal shapes.
class Shape {
  public:
    explicit Shape(std::string name) : name_(std::move(name)) {}
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;
    virtual ~Shape() = default;

    /// The primitive as `.inst` writes it.
    const std::string& name() const { return name_; }

    /// A value that follows from the shape alone, made by the first call under this key, which stands for
    /// one function. Safe to call from many threads; the value lives as long as the shape.
    template<typename Value, typename Make> const Value& derived(const void* key, const Make& make) const {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<const void>& place = derived_[key];
        if (!place) place = std::make_shared<const Value>(make());
        return *static_cast<const Value*>(place.get());
    }

  private:
    std::string name_;
    mutable std::recursive_mutex mutex_; ///< one value may be made of another
    mutable std::map<const void*, std::shared_ptr<const void>> derived_;
};

/// A primitive as a value: equal where it is the same set of points by the same name.
class Primitive {
  public:
    /// Requires a plain kind.
    constexpr Primitive(PrimitiveKind kind) : kind_(kind) {} // NOLINT: a kind is a primitive
    /// A stepped kind and its steps. Requires of a frustum 0 < steps < frustum_steps: radius 1 at y = 0 and
    /// steps / frustum_steps at y = 1.
    constexpr Primitive(PrimitiveKind kind, std::uint8_t steps) : kind_(kind), steps_(steps) {}
    /// Requires a shaped kind, and its own kind of shape: compiler/primitives makes these.
    Primitive(PrimitiveKind kind, std::shared_ptr<const Shape> shape)
        : kind_(kind), shape_(std::move(shape)) {}

    constexpr PrimitiveKind kind() const { return kind_; }
    /// The steps of a frustum; 0 of others.
    constexpr std::uint8_t steps() const { return steps_; }
    /// Null unless the kind is shaped.
    const std::shared_ptr<const Shape>& shape() const { return shape_; }

    std::size_t hash() const;

    friend bool operator==(const Primitive& a, const Primitive& b) {
        return a.kind_ == b.kind_ && a.steps_ == b.steps_ && shape_name(a) == shape_name(b);
    }
    friend std::strong_ordering operator<=>(const Primitive& a, const Primitive& b);
    /// Whether it is of the kind.
    friend constexpr bool operator==(const Primitive& a, PrimitiveKind kind) { return a.kind_ == kind; }

  private:
    static std::string_view shape_name(const Primitive& primitive) {
        return primitive.shape_ ? std::string_view(primitive.shape_->name()) : std::string_view();
    }

    PrimitiveKind kind_;
    std::uint8_t steps_ = 0;
    std::shared_ptr<const Shape> shape_;
};

/// The cone, frustum or cylinder whose radius at y = 1 is nearest. Requires 0 <= top_radius <= 1.
Primitive tapered(double top_radius);

PrimitiveForm form_of(PrimitiveKind kind);
/// The name that `.inst` uses for the kind, without parameters; static storage.
std::string_view name_of(PrimitiveKind kind);
/// The name that `.inst` uses, `frustum(0.5)` for one. Lives as long as the program or the shape.
const std::string& name_of(const Primitive& primitive);

/// The kind of this name.
std::optional<PrimitiveKind> primitive_kind_named(std::string_view name);
/// The primitive of this name, `frustum(0.5)` included; nothing for those with shapes, which take more to
/// make.
std::optional<Primitive> primitive_named(std::string_view name);

} // namespace graftal

template<> struct std::hash<graftal::Primitive> {
    std::size_t operator()(const graftal::Primitive& primitive) const { return primitive.hash(); }
};
