#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/run.h"
#include "compiler/lsys/turtle/limb.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/lsys/turtle/witness.h"

namespace graftal {

/// Where bodies go.
struct BodySink {
    std::vector<Instance>& instances;
    /// The body is as thick as lines are, and that is not known yet: its item is marked (open_width).
    bool open_width = false;
};

/// The mark in RunItem::colour of bodies of open width, until widen() has been called.
inline constexpr std::uint16_t open_width = 1u << 15;

/// Most triangles of the skins of a model's limbs; each takes about 200 bytes.
inline constexpr std::size_t most_skin_triangles = 4'000'000;

/// Most corners of the different outlines of a model's pictured polygons; each takes about 500 bytes.
inline constexpr std::size_t most_picture_corners = 1'000'000;

/// Makes the instances of what a turtle draws. A turtle's frame has x to its right, y ahead, and z up, so
/// that the canonical cylinder is a segment.
class TurtleBodies {
  public:
    /// Colour index k draws with `palette[k mod size]`. `graph` gets the primitives and materials that are
    /// used, a material that it has by this name is taken; it must outlive this. `packs`: round bodies become
    /// packed edges in place of instances.
    TurtleBodies(Graph& graph, std::vector<Material> palette, bool packs = false)
        : graph_(graph), palette_(std::move(palette)), run_(packs ? std::make_shared<Run>() : nullptr) {
        ids_.resize(palette_.size());
    }

    /// From now on bodies are told to the witness, which must outlive this, and not made.
    void tell(WordWitness& witness) { witness_ = &witness; }

    /// The place in the palette, from 0 on, of a whole number that is counted around it.
    int colour_index(double number) const;

    /// A cylinder with a ball at its far end, which fills the gap to what goes on from there.
    void add_segment(const Affine& start_from_turtle, double length, double width, int colour, Span span,
                     BodySink sink);
    /// A round piece from a point, of this width, to the turtle, of that, with a ball at the turtle. Its
    /// taper is rounded to 1/128 (primitive.h).
    void add_taper(const Affine& start_from_turtle, Vec3 from, double from_width, double width, int colour,
                   Span span, BodySink sink);
    /// One smooth body around a chain of segments, with rings of so many sides. Equal ones are made once.
    void add_limb(const Limb& limb, int sides, BodySink sink);
    /// The body in place of a line from the start to `end` that is too small to see: as thick as it is long,
    /// so that fine curves stay visible. Nothing if the points are equal.
    std::optional<Instance> line(Vec3 end, int colour, Span span);
    void add_sphere(const Affine& start_from_turtle, double diameter, int colour, Span span, BodySink sink);
    /// A flat disc about the turtle, in the plane of its heading and its left.
    void add_disc(const Affine& start_from_turtle, double diameter, int colour, Span span, BodySink sink);
    /// `axes`: the turtle's right, ahead and up where the polygon began. Its picture covers it once where it
    /// has an outline (polygon_outline.h), else each of its triangles. False if that is so for the first
    /// time.
    bool add_polygon(std::span<const Vec3> corners, const Mat3& axes, int colour, Span span, BodySink sink);
    void add_model(const PlacedModel& model, const Affine& start_from_turtle, Span span, BodySink sink);

    std::size_t packed_count() const { return run_ ? run_->size() : 0; } ///< items
    std::size_t skin_triangles() const { return skin_triangles_; }       ///< of all limbs
    /// Work of cutting all polygons into triangles, which grows with the square of their corners: so many
    /// instances would take as much.
    std::size_t polygon_work() const { return polygon_work_; }
    /// Makes packed bodies that are marked by open_width thicker by a factor, and takes the marks away.
    void widen_packed(double factor);
    /// The packed bodies, if there are any. Requires that nothing is added afterwards.
    PackedEdges take_packed();

  private:
    void tell(DrawnBody body, int colour) const;
    MaterialId material(int colour);
    void add_item(RunShape shape, Vec3 base, Vec3 axis, double radius, Vec3 x, bool ball, int colour,
                  const BodySink& sink);
    Instance body(const Primitive& primitive, const Affine& place, int colour, Span span);
    void add(const Primitive& primitive, const Affine& place, int colour, Span span, const BodySink& sink) {
        sink.instances.push_back(body(primitive, place, colour, span));
    }

    void find_shapes();
    /// The object of a shape, made where the graph has none. Nothing for numbers that make none.
    std::optional<ObjectId> shape(PrimitiveKind kind, std::span<const double> numbers);
    bool add_outline(std::span<const Vec3> corners, const Mat3& axes, int colour, Span span, BodySink sink);

    Graph& graph_;
    std::vector<Material> palette_;              ///< not empty
    std::vector<std::optional<MaterialId>> ids_; ///< of the palette's materials used so far
    std::shared_ptr<Run> run_;                   ///< of round bodies, or null
    WordWitness* witness_ = nullptr;
    std::unordered_map<Primitive, ObjectId> primitives_; ///< primitives used so far
    std::unordered_map<std::string, ObjectId> shapes_;   ///< skins and outlines, by their names,
    ObjectId known_shapes_ = 0;                          ///< among so many objects of the graph
    std::size_t skin_triangles_ = 0;
    std::size_t picture_corners_ = 0;
    std::size_t polygon_work_ = 0;
    bool split_a_picture_ = false; ///< add_polygon() has said so
};

} // namespace graftal
