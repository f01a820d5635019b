#pragma once

// Cuts put together by hand, and what is looked for in their scenes.

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/povray/emit/scene.h"

namespace graftal::by_hand {

inline Affine place(Vec3 at, Vec3 size) {
    return Affine::translate(at) * Affine::scale(size);
}

/// A cut put together by hand; one unit of it is 500 of POV-Ray's.
struct Scene {
    Cut cut;
    Graph graph;
    PovrayOptions options{.scene_name = "model"};
    std::vector<PaletteImage> pictures;

    Scene() {
        cut.bounds = {Vec3(-1), Vec3(1)};
        graph.root = graph.primitive(PrimitiveKind::sphere);
    }

    std::uint32_t body(const Primitive& kind) {
        cut.bodies.push_back({name_of(kind), kind});
        return static_cast<std::uint32_t>(cut.bodies.size() - 1);
    }

    /// Two triangles, of a slot each.
    std::uint32_t mesh(std::string name, std::uint32_t slot_count = 1) {
        Mesh mesh;
        mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        mesh.slot_count = slot_count;
        if (slot_count > 1) mesh.slot_of_triangle = {slot_count - 1, 0};
        cut.bodies.push_back({std::move(name), std::move(mesh)});
        return static_cast<std::uint32_t>(cut.bodies.size() - 1);
    }

    std::uint32_t palette(Palette palette) {
        cut.palettes.push_back(std::move(palette));
        return static_cast<std::uint32_t>(cut.palettes.size() - 1);
    }

    PlacementGroup& group(std::uint32_t palette, std::vector<Placement> placements, PathTint tint = {}) {
        cut.placement_count += placements.size();
        cut.groups.push_back({.palette = palette, .tint = tint, .placements = std::move(placements)});
        return cut.groups.back();
    }

    View view() const { return frame(graph, cut.bounds, {400, 300}, {}, {}, DefaultLight::plain); }

    std::string text() { return text(view()); }
    std::string text(const View& view) {
        std::string all;
        pictures.clear();
        EXPECT_TRUE(emit_povray(
            cut, view, options,
            [&](std::string_view piece) {
                all += piece;
                return true;
            },
            pictures));
        return all;
    }
};

inline std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++n;
    return n;
}

/// The three numbers after the first `keyword <`.
inline Vec3 vector_after(const std::string& text, const std::string& keyword) {
    std::size_t at = text.find(keyword + " <");
    EXPECT_NE(at, std::string::npos) << keyword;
    const char* p = text.c_str() + at + keyword.size() + 2;
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
        char* end = nullptr;
        v[i] = std::strtod(p, &end);
        p = end + 1;
    }
    return v;
}

inline Scene one_sphere() {
    Scene scene;
    scene.group(scene.palette({Rgb(1, 0, 0)}), {{scene.body(PrimitiveKind::sphere), {}}});
    return scene;
}

} // namespace graftal::by_hand
