#pragma once

// Runs: the parts that an honest derivation draws, where nothing repeats. Millions of single round parts lie
// side by side, each in 64 bytes. An instance takes three times as much and a master of its own.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"

namespace graftal {

/// The shape of an item of a run: a sphere, or a cylinder, cone or frustum. One byte.
class RunShape {
  public:
    static constexpr std::size_t count = frustum_steps + 2;

    constexpr RunShape() = default;
    /// Requires one of these kinds; for frusta see below.
    constexpr RunShape(PrimitiveKind kind) // NOLINT: a kind is a shape
        : top_steps_(kind == PrimitiveKind::sphere     ? sphere
                     : kind == PrimitiveKind::cylinder ? frustum_steps
                     : kind == PrimitiveKind::cone     ? 0
                                                       : unsound) {}
    /// Unsound for a primitive of another kind.
    RunShape(const Primitive& primitive); // NOLINT: likewise

    constexpr bool is_sphere() const { return top_steps_ == sphere; }
    constexpr bool is_sound() const { return top_steps_ <= sphere; }
    /// The radius at the far end, as a share of the radius at the base. Not of a sphere.
    constexpr double top_radius() const { return static_cast<double>(top_steps_) / frustum_steps; }
    Primitive primitive() const {
        if (is_sphere()) return PrimitiveKind::sphere;
        if (top_steps_ == 0) return PrimitiveKind::cone;
        if (top_steps_ == frustum_steps) return PrimitiveKind::cylinder;
        return {PrimitiveKind::frustum, top_steps_};
    }
    /// A number below `count`, another for each shape: spheres, cylinders, cones, frusta.
    constexpr std::size_t index() const {
        if (is_sphere()) return 0;
        return top_steps_ == frustum_steps ? 1 : 2u + top_steps_;
    }

    friend constexpr bool operator==(RunShape, RunShape) = default;

  private:
    static constexpr std::uint8_t sphere = frustum_steps + 1, unsound = sphere + 1;

    std::uint8_t top_steps_ = unsound; ///< the radius at the far end
};

/// A round primitive at its place: a cylinder, a cone, a frustum or a sphere; of a segment the ball at its
/// far end too. The numbers are those of the turtle, to the last bit.
struct RunItem {
    Vec3 base{0.0}; ///< of a sphere the centre
    Vec3 axis{0.0}; ///< from the base to the far end; of a sphere as long as the radius
    double radius = 0;
    /// The turn about the axis, in units of 2^-32 of a full turn, from where across() is. Only pictures on a
    /// surface show it; it is rounded to 7e-10 of the radius.
    std::uint32_t turn = 0;
    RunShape shape;
    bool ball = false;        ///< another part: a sphere of this radius at the far end
    std::uint16_t colour = 0; ///< one of PackedEdges::materials
};
static_assert(sizeof(RunItem) == 64);

/// A unit vector at right angles to one, the same on every machine (T. Duff et al., "Building an Orthonormal
/// Basis, Revisited", JCGT 2017).
Vec3 across(Vec3 unit);

/// The turn of an item whose x axis points to `x`, which is at right angles to the axis. Requires an axis
/// that is not zero.
std::uint32_t turn_of(Vec3 axis, Vec3 x);

/// Whether its numbers are finite, its kind is round, and neither axis nor radius is zero.
bool is_sound(const RunItem& item);

/// Where the primitive of an item lies.
Affine run_from_body(const RunItem& item);
/// Where the ball at its end lies.
Affine run_from_ball(const RunItem& item);

/// The places of body and ball, turned anyhow about the axis: cheaper, and round bodies look alike.
Affine run_from_round_body(const RunItem& item);
Affine run_from_round_ball(const RunItem& item);

class Run;

/// Orders items that were drawn here and there along a curve through space, so that those which follow each
/// other lie near each other: ranges of a run are looked at as wholes. Leaves a run as it is where they do
/// already, as the parts of most plants do. O(items), and log(items) times as much where it orders them.
void order_in_space(Run& run);

/// A list of items that grows without ever being copied.
class Run {
  public:
    void add(const RunItem& item) {
        if (size_ == capacity_) grow();
        chunks_[size_ >> chunk_bits][size_ & (chunk_size - 1)] = item;
        ++size_;
        parts_ += item.ball ? 2 : 1;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// Primitives, the balls included.
    std::size_t part_count() const { return parts_; }

    const RunItem& operator[](std::size_t i) const { return chunks_[i >> chunk_bits][i & (chunk_size - 1)]; }
    RunItem& operator[](std::size_t i) { return chunks_[i >> chunk_bits][i & (chunk_size - 1)]; }

    /// Gives back the room that is not used.
    void shrink_to_fit();

  private:
    static constexpr unsigned chunk_bits = 14;
    static constexpr std::size_t chunk_size = std::size_t{1} << chunk_bits;

    void grow();

    std::vector<std::unique_ptr<RunItem[]>> chunks_;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
    std::size_t parts_ = 0;
};

} // namespace graftal
