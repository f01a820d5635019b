#pragma once

// Arrays of numbers in the one buffer of a glTF model. Each function gives the number of what it adds.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tiny_gltf.h>

#include "compiler/support/tint.h"

namespace graftal {

/// Adds to one of the model's lists.
template<typename Value> int add_to(std::vector<Value>& list, Value value) {
    list.push_back(std::move(value));
    return static_cast<int>(list.size()) - 1;
}

/// A view of these bytes, which follow the others at the next multiple of four.
int add_view(tinygltf::Model& model, std::span<const std::byte> bytes, int target);

/// An accessor of a whole view. `component`, `type`: tinygltf's names of a number, and of how many make a
/// value.
int add_accessor(tinygltf::Model& model, int view, std::size_t count, int component, int type);

/// Vectors of 2, 3 or 4 numbers.
template<std::size_t n>
int add_vectors(tinygltf::Model& model, const std::vector<std::array<float, n>>& values,
                int target = TINYGLTF_TARGET_ARRAY_BUFFER) {
    static_assert(TINYGLTF_TYPE_VEC2 == 2 && TINYGLTF_TYPE_VEC3 == 3 && TINYGLTF_TYPE_VEC4 == 4);
    return add_accessor(model, add_view(model, std::as_bytes(std::span(values)), target), values.size(),
                        TINYGLTF_COMPONENT_TYPE_FLOAT, n);
}

/// Linear colours, in 16 bits a channel.
int add_colours(tinygltf::Model& model, const std::vector<Rgb>& colours);

/// The corners of triangles, in 16 bits where that is enough for so many vertices.
int add_corners(tinygltf::Model& model, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                std::size_t vertices);

} // namespace graftal
