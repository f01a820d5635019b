#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/graph/material.h"
#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"

namespace graftal {

class Run;

/// An edge to a round primitive, by value.
struct PackedEdge {
    Primitive primitive = PrimitiveKind::sphere;
    Affine parent_from_child;
    std::optional<MaterialId> material;
};

/// The edges of a union of round primitives, too many to be instances. They lie packed in a run (run.h), and
/// each is made where it is looked at. Copies share the run, for nobody changes it.
struct PackedEdges {
    class Iterator {
      public:
        Iterator(const PackedEdges& edges, std::size_t item) : edges_(&edges), item_(item) {}

        PackedEdge operator*() const;
        Iterator& operator++();
        bool operator==(const Iterator&) const = default;

      private:
        const PackedEdges* edges_;
        std::size_t item_;
        bool at_ball_ = false; ///< of the item
    };

    std::shared_ptr<const Run> run;                   ///< null: there are none
    std::vector<std::optional<MaterialId>> materials; ///< by the colours of the run

    explicit operator bool() const { return run != nullptr; }

    std::size_t size() const;
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, item_count()}; }

    /// An item packs one edge or two: a body, and the ball at its far end.
    std::size_t item_count() const;
    std::optional<MaterialId> material_of_item(std::size_t item) const;
    /// The first item whose numbers or colour no edge can have.
    std::optional<std::size_t> unsound_item() const;
};

} // namespace graftal
