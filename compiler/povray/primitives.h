#pragma once

#include <string>

#include "compiler/graph/primitive.h"
#include "compiler/povray/sdl_writer.h"
#include "compiler/support/affine.h"

namespace graftal {

/// POV-Ray's form of a primitive, and its cost.
struct PovrayPrimitive {
    /// SDL of the primitive, up to the modifiers.
    std::string (*text)(const Primitive&);
    /// Writes the primitive under a map without a matrix, up to the modifiers, where that is possible. Null:
    /// it never is.
    bool (*write_placed)(SdlWriter&, const Primitive&, const Affine& place) = nullptr;
    /// Whether a map leaves it of its kind, so that it may be written without a matrix. Null: no map does.
    bool (*stays_of_its_kind)(const Mat3& linear) = nullptr;
    /// Memory of one that is placed, without a matrix, in bytes (docs/benchmarks/memory.md).
    double (*bytes)(const Primitive&);
    /// Bytes of the declaration of a primitive that is declared once and then placed. Null: each is written
    /// where it is placed.
    double (*declared_bytes)(const Primitive&) = nullptr;
    /// Whether maps leave it of its kind so seldom that a matrix counts beforehand.
    bool mostly_needs_matrix = false;
};

const PovrayPrimitive& povray_primitive(PrimitiveKind kind);

} // namespace graftal
