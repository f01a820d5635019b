#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "compiler/graph/primitive.h"

namespace graftal {

/// Numbers primitives from 0 on, in the order in which they are met: a number takes less room than a
/// primitive where there are millions.
class PrimitiveNumbers {
  public:
    std::uint32_t of(const Primitive& primitive) {
        if (last_ < primitives_.size() && primitives_[last_] == primitive) return last_;
        const auto [place, added] =
            numbers_.emplace(primitive, static_cast<std::uint32_t>(primitives_.size()));
        if (added) primitives_.push_back(primitive);
        return last_ = place->second;
    }

    const Primitive& operator[](std::uint32_t number) const { return primitives_[number]; }

  private:
    std::unordered_map<Primitive, std::uint32_t> numbers_;
    std::vector<Primitive> primitives_;
    std::uint32_t last_ = 0;
};

} // namespace graftal
