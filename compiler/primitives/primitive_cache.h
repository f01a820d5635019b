#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// Values that follow from the primitive alone, each made by the first that asks for it. Safe to use from
/// many threads, and what get() returns stays where it is.
template<typename Value> class PrimitiveCache {
  public:
    template<typename Make> const Value& get(const Primitive& primitive, const Make& make) {
        if (const Shape* const shape = primitive.shape().get()) return shape->derived<Value>(this, make);
        Slot& slot = slots_[static_cast<std::size_t>(primitive.kind())][primitive.steps()];
        std::call_once(slot.made, [&] { slot.value = make(); });
        return slot.value;
    }

  private:
    struct Slot {
        std::once_flag made;
        Value value{};
    };
    std::array<std::array<Slot, frustum_steps>, primitive_kind_count> slots_;
};

} // namespace graftal
