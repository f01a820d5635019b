#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/detail/mesh/mesh.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Numbers the distinct tuples of colours that leaves take, one of each painter, in the order of the leaves.
class SlotTable {
  public:
    explicit SlotTable(std::size_t painters) : palettes_(painters) {}

    void reserve(std::size_t leaves);
    /// The colours of one more leaf, by painter.
    void add(std::span<const Rgb> colours);

    std::uint32_t slot_count() const { return static_cast<std::uint32_t>(palettes_.front().size()); }
    std::uint32_t slot_of(std::uint32_t leaf) const { return slot_of_leaf_[leaf]; }
    /// The slots' colours by painter; one colour where all slots have the same.
    std::vector<Palette> take_palettes();

  private:
    std::vector<Palette> palettes_; ///< by painter, all of one size
    std::vector<std::uint32_t> slot_of_leaf_;
    IdTable slot_ids_;
};

} // namespace graftal
