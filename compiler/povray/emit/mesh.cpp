#include "compiler/povray/emit/mesh.h"

#include <array>
#include <string>

#include "compiler/povray/emit/palette.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr int vertex_digits = 9; // enough to read back a float32, which POV-Ray keeps
constexpr int normal_digits = 6;
constexpr int uv_digits = 9;
constexpr std::size_t items_per_line = 4;

/// Between the items of a list.
void separate(SdlWriter& out, std::size_t i) {
    if (i == 0) return;
    out << (i % items_per_line == 0 ? std::string_view(",\n    ") : std::string_view(","));
}

void begin_list(SdlWriter& out, std::string_view keyword, std::size_t count) {
    out << "  " << keyword << " { " << static_cast<std::uint64_t>(count) << ",\n    ";
}

bool write_vectors(SdlWriter& out, std::string_view keyword, const std::vector<Vec3>& vectors, int digits) {
    begin_list(out, keyword, vectors.size());
    for (std::size_t i = 0; i < vectors.size() && !out.stopped(); ++i) {
        separate(out, i);
        out.vector(vectors[i], digits);
    }
    out << " }\n";
    return !out.stopped();
}

/// The slots that the triangles name, numbered in order of first use: a mesh may use few of many.
class UsedSlots {
  public:
    explicit UsedSlots(const Mesh& mesh) : place_of_(mesh.slot_count, unused) {
        for (const std::uint32_t slot : mesh.slot_of_triangle) {
            GRAFTAL_CHECK(slot < mesh.slot_count, "emit_povray: a triangle without a slot");
            if (place_of_[slot] != unused) continue;
            place_of_[slot] = static_cast<std::uint32_t>(slots_.size());
            slots_.push_back(slot);
        }
    }

    const std::vector<std::uint32_t>& slots() const { return slots_; }
    std::uint32_t place_of(std::uint32_t slot) const { return place_of_[slot]; }

  private:
    static constexpr std::uint32_t unused = UINT32_MAX;

    std::vector<std::uint32_t> place_of_;
    std::vector<std::uint32_t> slots_;
};

void write_uv_vectors(SdlWriter& out, const UsedSlots& used, std::uint32_t slot_count) {
    const PaletteLayout layout(slot_count);
    begin_list(out, "uv_vectors", used.slots().size());
    for (std::size_t i = 0; i < used.slots().size() && !out.stopped(); ++i) {
        separate(out, i);
        const auto [u, v] = layout.uv(used.slots()[i]);
        out << "<";
        out.number(u, uv_digits) << ",";
        out.number(v, uv_digits) << ">";
    }
    out << " }\n";
}

void write_uv_vectors(SdlWriter& out, const std::vector<std::array<double, 2>>& uv) {
    begin_list(out, "uv_vectors", uv.size());
    for (std::size_t i = 0; i < uv.size() && !out.stopped(); ++i) {
        separate(out, i);
        out << "<";
        out.number(uv[i][0], uv_digits) << ",";
        out.number(uv[i][1], uv_digits) << ">";
    }
    out << " }\n";
}

} // namespace

bool declare_mesh(SdlWriter& out, std::string_view name, const Mesh& mesh, bool palette, bool solid,
                  ProgressMarks& progress) {
    GRAFTAL_CHECK(!mesh.triangles.empty(), "emit_povray: a mesh without triangles");
    GRAFTAL_CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size(),
                  "emit_povray: a mesh whose normals are not one a vertex");
    out << "#declare " << name << " = mesh2 {\n";
    if (!write_vectors(out, "vertex_vectors", mesh.vertices, vertex_digits)) return false;
    if (!mesh.normals.empty() && !write_vectors(out, "normal_vectors", mesh.normals, normal_digits))
        return false;

    palette = palette && mesh.slot_count > 1;
    GRAFTAL_CHECK(!palette || mesh.slot_of_triangle.size() == mesh.triangles.size(),
                  "emit_povray: a mesh whose slots are not one a triangle");
    const UsedSlots used(palette ? mesh : Mesh{});
    if (palette) write_uv_vectors(out, used, mesh.slot_count);
    // Their indices are those of the vertices, which is what POV-Ray takes where there are none.
    if (!mesh.uv.empty()) write_uv_vectors(out, mesh.uv);

    begin_list(out, "face_indices", mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size() && !out.stopped(); ++i) {
        separate(out, i);
        const auto& [a, b, c] = mesh.triangles[i];
        out.indices(a, b, c);
        progress.step();
    }
    out << " }\n";
    if (palette) {
        begin_list(out, "uv_indices", mesh.triangles.size());
        for (std::size_t i = 0; i < mesh.triangles.size() && !out.stopped(); ++i) {
            separate(out, i);
            const std::uint32_t place = used.place_of(mesh.slot_of_triangle[i]);
            out.indices(place, place, place);
        }
        out << " }\n";
    }
    if (solid) out << inside_vector << "\n";
    out << "}\n";
    return !out.stopped();
}

} // namespace graftal
