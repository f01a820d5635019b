#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// Values that follow from the primitive alone, each made by the first that asks for it. Safe to use from
/// many threads, and what get() returns stays where it is.
template<typename Value> class PrimitiveCache {
  public:
    template<typename Make> const Value& get(const Primitive& primitive, const Make& make) {
        if (const Shape* const shape = primitive.shape().get()) return shape->derived<Value>(this, make);
        std::atomic<const Value*>& made =
            made_[static_cast<std::size_t>(primitive.kind())][primitive.steps()];
        if (const Value* const value = made.load(std::memory_order_acquire)) return *value;
        const std::lock_guard lock(mutex_);
        if (const Value* const value = made.load(std::memory_order_relaxed)) return *value;
        values_.push_back(std::make_unique<const Value>(make()));
        made.store(values_.back().get(), std::memory_order_release);
        return *values_.back();
    }

  private:
    std::recursive_mutex mutex_; ///< one value may be made of another
    std::vector<std::unique_ptr<const Value>> values_;
    /// Pointers, for few of them are ever made.
    std::array<std::array<std::atomic<const Value*>, frustum_steps>, primitive_kind_count> made_{};
};

} // namespace graftal
