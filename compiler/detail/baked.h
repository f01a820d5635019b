#pragma once

// A subtree as meshes: what is asked for, and what comes out.

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/mesh/mesh.h"
#include "compiler/detail/self_shadow.h"
#include "compiler/support/control.h"

namespace graftal {

/// A colouring of a mesh: the pair (representative, node) gives the tints, `inherited` the colour of what
/// names no material.
struct Painter {
    std::uint32_t pair = 0;
    Rgb inherited{0.8};
};

class ShellStore;

/// One subtree to become meshes, in the frame of its class's representative.
struct BakeRequest {
    NodeId representative = 0;
    std::uint32_t steps = unlimited_steps;
    double detail_per_unit = 0; ///< of the representative's frame, where it is seen largest
    double pixels_per_unit = 0; ///< likewise; decides how finely curved surfaces are meshed
    double error_px = 0;        ///< Projection::error_px()
    /// Linear part of the map that places the representative, divided by the least half width there
    /// (least_width.h): thin parts are widened as they are seen. All zero: nothing is culled.
    Mat3 half_widths_from_unit{0.0};
    std::optional<MaterialId> material; ///< the finish of what names no material
    std::vector<Painter> painters;
    double expected_leaves = 0;                ///< about; what is known of it saves memory
    bool limit_normals = false;                ///< of proxies, where nothing was crushed
    const SelfShadows* self_shadows = nullptr; ///< none: whatever stands for parts has its own light
    std::uint64_t most_made_triangles = UINT64_MAX;
    std::uint64_t most_shell_work = UINT64_MAX; ///< points moved for a shell: it gets coarser by that
    bool shell =
        false; ///< a shell (shell/shell.h) of this very node, of whose painters the colour alone counts
    ShellStore* shells = nullptr;           ///< where its points are kept; none: they are made anew
    bool pictures = true;                   ///< else what has a texture shows its material's colour
    std::uint64_t most_visits = UINT64_MAX; ///< of the walk through the subtree
    CancelFlag cancel{};                    ///< ends it by Cancelled
};

/// The triangles of one finish, and what each painter's colours are.
struct BakedPart {
    std::optional<MaterialId> material;
    Mesh mesh;
    std::vector<Palette> palettes; ///< by painter
    bool textured = false; ///< by the material's picture or pattern, behind this tint; requires one painter
    PathTint tint;
    double size = 1;        ///< of a pattern: about part_size() in the representative's frame
    double light_share = 1; ///< share of the light on it (self_shadow.h)
};

struct Baked {
    Affine representative_from_body; ///< scaling by a power of two, so that coordinates stay exact
    std::vector<BakedPart> parts;
    std::size_t triangles = 0;
    double culled_detail = 0; ///< largest detail of a culled part
    double tessellation_px = 0;
    std::uint64_t visits = 0; ///< of the walk
    /// Triangles as work: those of pictures cost more, and those that other faces hide were made, too.
    std::uint64_t made_triangles = 0;
    std::uint64_t shell_work = 0; ///< points moved for a shell
    bool complete = true;         ///< false: stopped at a limit of triangles or visits, or where memory ended
};

/// Largest error of curved surfaces where parts of `error_px` pixels are culled. If surfaces were much finer
/// than the parts that are left, nobody would see it, and few would fit the memory.
inline constexpr double tessellation_tolerance_px = 0.2;
constexpr double tessellation_tolerance(double error_px) {
    return error_px > 4 * tessellation_tolerance_px ? error_px / 4 : tessellation_tolerance_px;
}

} // namespace graftal
