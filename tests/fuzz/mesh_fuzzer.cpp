// Meshes in files: any bytes give triangles within the limits or a message, and the laws of the table hold
// for whatever mesh comes out.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <glm/geometric.hpp>

#include "compiler/primitives/intersect.h"
#include "compiler/primitives/mesh_file.h"
#include "compiler/support/check.h"

using namespace graftal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string fault;
    const std::optional<MeshData> read = read_mesh({reinterpret_cast<const char*>(data), size}, fault);
    if (!read) {
        GRAFTAL_CHECK(!fault.empty(), "mesh fuzzer: a mesh or a message");
        return 0;
    }
    GRAFTAL_CHECK(!read->triangles.empty() && read->triangles.size() <= most_mesh_triangles,
                  "mesh fuzzer: some triangles, and not too many");
    GRAFTAL_CHECK(read->uv.empty() || read->uv.size() == read->triangles.size(),
                  "mesh fuzzer: a picture or none");
    for (const auto& triangle : read->triangles)
        for (const std::uint32_t corner : triangle)
            GRAFTAL_CHECK(corner < read->vertices.size(), "mesh fuzzer: corners are there");
    const Primitive mesh = mesh_primitive("leaf.obj", *read);
    const PrimitiveTraits& traits = traits_of(mesh);
    const Ball ball = traits.ball(mesh);
    GRAFTAL_CHECK(std::isfinite(ball.radius) && traits.area(mesh) > 0, "mesh fuzzer: bounds and an area");
    for (int i = 0; i < 8; ++i) {
        const Vec3 direction(i & 1 ? 1 : -1, i & 2 ? 0.6 : -0.3, i & 4 ? 0.2 : -0.7);
        const double support = primitive_support(mesh, direction);
        for (const Vec3& vertex : read->vertices)
            GRAFTAL_CHECK(glm::dot(vertex, direction) <= support + 1e-9 * ball.radius,
                          "mesh fuzzer: nothing lies beyond the support");
        const SurfaceSite site = traits.site(mesh, {0.3, 0.6, 0.125 * i});
        GRAFTAL_CHECK(std::isfinite(glm::length(site.point)), "mesh fuzzer: sites have places");
        PrimitiveHit hit;
        const Ray ray{site.point - 2 * ball.radius * direction, direction};
        if (intersect(mesh, ray, {}, hit))
            GRAFTAL_CHECK(std::abs(glm::length(hit.normal) - 1) < 1e-6, "mesh fuzzer: normals are units");
    }
    return 0;
}
