#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "compiler/primitives/mesh_file.h"
#include "compiler/primitives/primitive.h"
#include "tests/unit/primitives/all_primitives.h"

namespace graftal::test {

/// The primitive of a kind that numbers make.
inline Primitive made_of(PrimitiveKind kind, std::vector<double> numbers) {
    std::string fault;
    std::optional<Primitive> primitive = traits_of(kind).make(numbers, fault);
    if (!primitive) throw std::runtime_error(fault);
    return *primitive;
}

/// A square hole, and an island in it.
inline std::vector<double> framed_square() {
    return {-1,  -1,  1,    -1,  1,    1,    -1,   1,    -1,  -1,   -0.5, -0.5, 0.5,  -0.5,
            0.5, 0.5, -0.5, 0.5, -0.5, -0.5, -0.2, -0.2, 0.2, -0.2, 0.2,  0.2,  -0.2, -0.2};
}

/// A tetrahedron whose faces have corners of their own, with a picture on each.
inline MeshData tetrahedron() {
    MeshData data;
    const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::array<std::uint32_t, 3> faces[] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    data.vertices.assign(std::begin(corners), std::end(corners));
    for (const auto& face : faces) {
        data.triangles.push_back(face);
        data.uv.push_back({{{0, 0}, {1, 0}, {0, 1}}});
    }
    return data;
}

/// A sail: control points over a square that bulge, with one edge shrunk to a point if asked.
inline std::vector<double> sail(bool pointed) {
    std::vector<double> numbers;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            const bool inner = row % 3 != 0 && column % 3 != 0;
            if (pointed && row == 3)
                numbers.insert(numbers.end(), {1.0, 2.0, 0.0});
            else
                numbers.insert(numbers.end(), {column / 1.5, row / 1.5, inner ? 1.0 : 0.1 * column});
        }
    return numbers;
}

/// Some of every kind.
inline std::vector<Primitive> sample_primitives() {
    std::vector<Primitive> samples = some_primitives();
    for (const double e : {0.1, 0.5, 1.0, 2.0})
        for (const double n : {0.2, 1.0, 1.7, 2.0})
            samples.push_back(made_of(PrimitiveKind::superellipsoid, {e, n}));
    samples.push_back(made_of(PrimitiveKind::polygon, {0, 0, 2, 0, 1, 1, 2, 2, 0, 2}));
    samples.push_back(made_of(PrimitiveKind::polygon, framed_square()));
    samples.push_back(made_of(PrimitiveKind::bicubic_patch, sail(false)));
    samples.push_back(made_of(PrimitiveKind::bicubic_patch, sail(true)));
    samples.push_back(made_of(PrimitiveKind::sphere_sweep, {0, 0, 0, 0.5, 0, 2, 0, 0.5}));
    samples.push_back(made_of(PrimitiveKind::sphere_sweep, {0, 0, 0, 0.3, 0, 1, 0, 0.2, 1, 1.5, 0.5, 0.05}));
    samples.push_back(made_of(PrimitiveKind::limb_sweep, {12, 0, 0, 0, 0, 0, 0.4, 0, 1, 0, 0.4}));
    samples.push_back(made_of(PrimitiveKind::limb_sweep, {9, 0.35, 0.1, 0, 0, 0, 0.3, 0, 0.5, 0, 0.3, 0.4,
                                                          0.9, 0.2, 0.28, 0.5, 1.1, 0.1, 0.24}));
    samples.push_back(mesh_primitive("tetrahedron.obj", tetrahedron()));
    return samples;
}

} // namespace graftal::test
