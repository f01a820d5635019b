#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "compiler/lsys/compile/module_table.h"
#include "compiler/lsys/turtle/state.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// The parts that are composed already (composer.h), by their module, its stage and as much of the state
/// that came in as they read.
class PartTable {
  public:
    using Stage = std::uint32_t;

    /// `start`: the state that it was composed for.
    void add(ModuleId module, Stage stage, const TurtleState& start, TurtlePart part);

    /// One that was composed for a state that is equal where it reads; null if there is none. It stays where
    /// it is.
    const TurtlePart* find(ModuleId module, Stage stage, const TurtleState& start) const;

    std::size_t size() const { return parts_.size(); }
    /// Bytes of the parts, of their limbs and of the polygons that they leave open, without those that they
    /// hold elsewhere.
    std::size_t bytes() const {
        return parts_.size() * sizeof(KnownPart) + limb_nodes_ * sizeof(LimbNode) + vertices_ * sizeof(Vec3);
    }

  private:
    struct PartKind {
        ModuleId module = 0;
        Stage stage = 0;
        std::vector<TurtleStateMask> reads; ///< of the known parts, each once
    };

    struct KnownPart {
        std::uint32_t kind = 0;
        TurtleState start;
        TurtlePart part;
    };

    std::deque<KnownPart> parts_;
    IdTable part_ids_;
    std::vector<PartKind> kinds_;
    IdTable kind_ids_;
    std::size_t limb_nodes_ = 0;
    std::size_t vertices_ = 0;
};

} // namespace graftal
