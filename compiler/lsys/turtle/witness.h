#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "compiler/graph/graph.h"
#include "compiler/lower/plant.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/support/affine.h"

namespace graftal {

class Turtle;

/// A body in the frame of the part that draws it.
struct DrawnBody {
    Organ organ = Organ::none;
    double length = 0;     ///< of segments
    double width = 0;      ///< diameter; of a tapered segment that at its end
    double base_width = 0; ///< of segments, where they begin
    double area = 0;       ///< of the surface; of flat bodies one side
    double volume = 0;
    bool is_measured = true;                  ///< or neither area nor volume are known
    std::string_view material;                ///< empty: a model has its own
    std::optional<Vec3> start;                ///< nothing: where the turtle was
    std::span<const PlantTriangle> triangles; ///< of a polygon
    const Graph* graph = nullptr;             ///< of a model: the graph that has it,
    ObjectId model = 0;                       ///< its root there,
    Affine part_from_model;                   ///< and its place
};

/// The frame of a part in the world: turned and shifted by a map, and so many times as large.
struct PartFrame {
    Affine world_from_part;
    double size = 1;

    Vec3 place(Vec3 point) const {
        return world_from_part.linear * (size * point) + world_from_part.translation;
    }
    /// The frame of a part that stands there in this one.
    PartFrame of_child(const Affine& part_from_child, double scale) const {
        return {{world_from_part.linear * part_from_child.linear, place(part_from_child.translation)},
                size * scale};
    }
};

/// Hears of a word while a turtle draws it: of its modules, in order, and of the bodies of each.
class WordWitness {
  public:
    struct Module {
        SymbolId symbol = 0;
        std::span<const double> parameters; ///< as the model writes them
        std::uint32_t birth = ModuleTable::no_birth;
        bool is_interpreted = false; ///< other modules are drawn in its place
    };

    virtual ~WordWitness() = default;

    /// From now on all is told in this frame.
    void enter(const PartFrame& frame) { frame_ = frame; }
    /// A module of the word, before it and after all that it is drawn as. False after an error.
    virtual bool begins(const Module& module, const Turtle& turtle) = 0;
    virtual void ends(const Turtle&) {}
    /// A module, of the word or in the place of one, before and after the turtle carries it out. False after
    /// an error.
    virtual void runs(SymbolId, std::span<const double>, const Turtle&) {}
    virtual bool has_run(const Turtle&) { return true; }
    virtual void draws(const DrawnBody&) {}
    /// A branch whose brackets are no modules here begins or ends.
    virtual void opens_branch() {}
    virtual void closes_branch() {}

    /// Whether each part is told once only, in its own frame, and then by its number wherever it stands: all
    /// between opens_part() and closes_part() is of the part.
    virtual bool sums() const { return false; }
    virtual void opens_part() {}
    /// The number of the part that ends.
    virtual std::uint32_t closes_part() { return 0; }
    /// The part stands here, so many times as large. False as begins() is.
    virtual bool places(std::uint32_t /*part*/, double /*scale*/) { return true; }

  protected:
    PartFrame frame_;
};

} // namespace graftal
