#include "compiler/lsys/turtle/flat_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/primitives/sheet.h"
#include "compiler/primitives/solid.h"
#include "compiler/primitives/tessellate.h"

namespace graftal {

namespace {

/// Parts that may still be looked at.
struct Room {
    int objects = 1000;
    std::size_t triangles = 20'000; ///< of meshes
};

/// A primitive of a flat model.
struct FlatPart {
    const Primitive& primitive;
    const TessellatedPrimitive& mesh;
    std::optional<Sheet> sheet; ///< that it is in the model's frame; else it encloses no volume
    Affine model_from_part;
    Affine placed_from_part; ///< under the map that is asked for
};

/// Calls `visit` with each part below an object. False where there is anything else, or too much. Sheets are
/// told apart in the model's own frame, so that each placement of the model has the same parts.
template<typename Visit>
bool each_flat(const Graph& graph, ObjectId id, const Affine& model_from_object,
               const Affine& placed_from_object, Room& room, const Visit& visit) {
    constexpr double roundness = 2e-3; // a disc has 48 sides
    const Object& object = graph.objects[id];
    if (--room.objects < 0 || object.is_combined() || object.packed) return false;
    if (object.primitive) {
        const Primitive& primitive = *object.primitive;
        std::optional<Sheet> sheet;
        if (encloses_volume(primitive)) {
            sheet = sheet_of(primitive, model_from_object.linear);
            if (!sheet) return false;
        }
        const TessellatedPrimitive& mesh = tessellated(primitive, fineness_for(primitive, roundness));
        if (mesh.triangles.size() > room.triangles) return false;
        room.triangles -= mesh.triangles.size();
        visit(FlatPart{primitive, mesh, sheet, model_from_object, placed_from_object});
        return true;
    }
    return std::ranges::all_of(object.instances, [&](const Instance& part) {
        return each_flat(graph, part.master, model_from_object * part.parent_from_child,
                         placed_from_object * part.parent_from_child, room, visit);
    });
}

double area_of(const PlantTriangle& triangle) {
    return glm::length(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
}

/// The area of a face of a cylinder that is a sheet by its height, as a turtle's disc is; else nothing.
std::optional<double> disc_area(const FlatPart& part, const Mat3& linear) {
    const auto face = [](const Mat3& map) { return glm::length(glm::cross(map[2], map[0])); };
    const Mat3& map = part.model_from_part.linear;
    const double side =
        std::max(glm::length(glm::cross(map[0], map[1])), glm::length(glm::cross(map[1], map[2])));
    if (!part.sheet || part.primitive != PrimitiveKind::cylinder || !(face(map) > side)) return std::nullopt;
    return std::numbers::pi * face(linear);
}

/// Triangles of one side of a sheet, moved along its normal to halfway between its faces. A disc keeps its
/// area.
std::vector<PlantTriangle> side_of_sheet(const FlatPart& part) {
    constexpr double edge_on = 1e-3;
    const Affine& place = part.model_from_part;
    const Vec3 normal = part.sheet->normal, along = normal * place.linear;
    const double middle =
        glm::dot(normal, place.translation) +
        (primitive_support(part.primitive, along) - primitive_support(part.primitive, -along)) / 2;
    const auto flat = [&](std::uint32_t vertex) {
        const Vec3 point = place(part.mesh.vertices[vertex]);
        return point - (glm::dot(normal, point) - middle) * normal;
    };
    std::vector<PlantTriangle> side;
    double sum = 0;
    for (const auto& [a, b, c] : part.mesh.triangles) {
        const Vec3 corner = place(part.mesh.vertices[a]);
        const Vec3 facing =
            glm::cross(place(part.mesh.vertices[b]) - corner, place(part.mesh.vertices[c]) - corner);
        if (!(glm::dot(normal, facing) > edge_on * glm::length(facing))) continue;
        side.push_back({flat(a), flat(b), flat(c)});
        sum += area_of(side.back());
    }
    const std::optional<double> disc = disc_area(part, place.linear);
    if (!disc || !(sum > 0)) return side;
    const Vec3 centre = place.translation + (middle - glm::dot(normal, place.translation)) * normal;
    for (PlantTriangle& triangle : side)
        for (Vec3& corner : triangle)
            corner = centre + std::sqrt(*disc / sum) * (corner - centre);
    return side;
}

std::vector<PlantTriangle> side_of(const FlatPart& part) {
    if (part.sheet) return side_of_sheet(part);
    const Affine& place = part.model_from_part;
    std::vector<PlantTriangle> side;
    for (const auto& [a, b, c] : part.mesh.triangles)
        side.push_back(
            {place(part.mesh.vertices[a]), place(part.mesh.vertices[b]), place(part.mesh.vertices[c])});
    return side;
}

} // namespace

std::optional<double> flat_area(const Graph& graph, ObjectId root, const Mat3& linear) {
    double sum = 0;
    Room room;
    const auto add = [&](const FlatPart& part) {
        const Mat3& placed = part.placed_from_part.linear;
        if (part.primitive == PrimitiveKind::triangle || part.primitive == PrimitiveKind::polygon) {
            sum += traits_of(part.primitive).area(part.primitive) *
                   glm::length(glm::cross(placed[0], placed[1]));
        } else if (const std::optional<double> disc = disc_area(part, placed)) {
            sum += *disc;
        } else {
            for (const auto& [a, b, c] : side_of(part))
                sum += area_of({linear * a, linear * b, linear * c});
        }
    };
    const bool flat = each_flat(graph, root, {}, {linear, Vec3(0.0)}, room, add);
    return flat ? std::optional(sum) : std::nullopt;
}

FlatSide flat_side(const Graph& graph, ObjectId root) {
    FlatSide flat;
    Room room;
    const auto add = [&](const FlatPart& part) {
        const std::vector<PlantTriangle> side = side_of(part);
        flat.triangles.insert(flat.triangles.end(), side.begin(), side.end());
        if (part.sheet) flat.half_thickness = std::max(flat.half_thickness, part.sheet->thickness / 2);
    };
    return each_flat(graph, root, {}, {}, room, add) ? flat : FlatSide();
}

} // namespace graftal
