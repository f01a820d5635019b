#pragma once

#include <cstdint>
#include <vector>

#include "compiler/graph/primitive.h"

namespace graftal::test {

/// Each plain primitive and each frustum.
inline std::vector<Primitive> all_primitives() {
    std::vector<Primitive> all;
    for (const PrimitiveKind kind : all_primitive_kinds)
        if (form_of(kind) == PrimitiveForm::plain) all.emplace_back(kind);
    for (int steps = 1; steps < frustum_steps; ++steps)
        all.emplace_back(PrimitiveKind::frustum, static_cast<std::uint8_t>(steps));
    return all;
}

/// The same, of the frusta a few.
inline std::vector<Primitive> some_primitives() {
    std::vector<Primitive> some;
    for (const Primitive& primitive : all_primitives())
        if (primitive.steps() % 42 < 2) some.push_back(primitive);
    return some;
}

} // namespace graftal::test
