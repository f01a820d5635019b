#include "runtime/inverse/found/voxel_target.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/support/bounds.h"

namespace graftal {

namespace {

constexpr std::array<int, 5> sides = {64, 48, 32, 24, 16}; ///< cells along the longest side of the box
constexpr std::size_t most_voxels = 20'000, least_voxels = 24;
constexpr std::size_t points_a_voxel = 4;   ///< of a cloud, on average
constexpr double most_lattice_points = 1e8; ///< on all triangles
/// Room around the box, in cells. Sets that halve or double would else lie along the borders of cells.
constexpr double margin = 0.25;
constexpr double least_extent = 1e-9; ///< of the box, over the largest coordinate

std::array<Vec3, 3> corners_of(const MeshData& data, const std::array<std::uint32_t, 3>& triangle) {
    return {data.vertices[triangle[0]], data.vertices[triangle[1]], data.vertices[triangle[2]]};
}

Box box_of(const MeshData& data) {
    Box box;
    if (data.triangles.empty())
        for (const Vec3 p : data.vertices)
            box.include(p);
    for (const auto& triangle : data.triangles)
        for (const Vec3 p : corners_of(data, triangle))
            box.include(p);
    return box;
}

/// Steps along a triangle's sides that are no longer than half a cell.
double lattice_steps(const std::array<Vec3, 3>& corners, double cell) {
    const double longest =
        std::max({glm::length(corners[1] - corners[0]), glm::length(corners[2] - corners[1]),
                  glm::length(corners[0] - corners[2])});
    return std::max(1.0, std::ceil(2 * longest / cell));
}

class VoxelSet {
  public:
    VoxelSet(const Box& box, double cell) {
        target_.corner = box.min - margin * cell;
        target_.cell = cell;
        std::array<int, 3> size{};
        for (int k = 0; k < 3; ++k)
            size[static_cast<std::size_t>(k)] = std::max(
                1, static_cast<int>(std::ceil((box.max[k] - box.min[k]) / cell + 2 * margin - 1e-6)));
        target_.cells = CellSet(size[0], size[1], size[2]);
    }

    void add(Vec3 p) {
        const Vec3 place = (p - target_.corner) / target_.cell;
        CellSet& set = target_.cells;
        const std::size_t cell = set.index(std::clamp(static_cast<int>(place.x), 0, set.width - 1),
                                           std::clamp(static_cast<int>(place.y), 0, set.height - 1),
                                           std::clamp(static_cast<int>(place.z), 0, set.depth - 1));
        if (set.cells[cell]) return;
        set.cells[cell] = true;
        ++target_.set;
    }

    void add_triangle(const std::array<Vec3, 3>& corners) {
        const double steps = lattice_steps(corners, target_.cell);
        for (double i = 0; i <= steps; ++i)
            for (double j = 0; i + j <= steps; ++j)
                add(corners[0] + (i / steps) * (corners[1] - corners[0]) +
                    (j / steps) * (corners[2] - corners[0]));
    }

    VoxelTarget& target() { return target_; }

  private:
    VoxelTarget target_;
};

double lattice_points(const MeshData& data, double cell) {
    double points = 0;
    for (const auto& triangle : data.triangles) {
        const double steps = lattice_steps(corners_of(data, triangle), cell);
        points += 0.5 * (steps + 1) * (steps + 2);
    }
    return points;
}

} // namespace

std::optional<VoxelTarget> voxels_of(const MeshData& data, std::string& fault) {
    const bool cloud = data.triangles.empty();
    const Box box = box_of(data);
    const Vec3 size = box.size();
    const double extent = std::max({size.x, size.y, size.z});
    const double farthest = std::max(largest_entry(box.min), largest_entry(box.max));
    if (data.vertices.empty()) {
        fault = "it has no points";
        return std::nullopt;
    }
    if (!(extent > least_extent * farthest && extent > 1e-100)) {
        fault =
            fmt::format("its points lie no farther apart than {:.3g}, which tells nothing of maps", extent);
        return std::nullopt;
    }
    std::optional<VoxelTarget> best; // the coarsest that tells enough, if none suits in all
    bool too_long = false;
    for (const int side : sides) {
        const double cell = extent / (side - 2 * margin);
        if (too_long = lattice_points(data, cell) > most_lattice_points; too_long) continue;
        VoxelSet voxels(box, cell);
        for (const auto& triangle : data.triangles)
            voxels.add_triangle(corners_of(data, triangle));
        if (cloud)
            for (const Vec3 p : data.vertices)
                voxels.add(p);
        const std::size_t set = voxels.target().set;
        if (set < least_voxels) break;
        best = std::move(voxels.target());
        if (set <= most_voxels && (!cloud || data.vertices.size() >= points_a_voxel * set)) break;
    }
    if (!best && too_long)
        fault =
            fmt::format("its {} triangles are too many for their size: graftal walks over each in steps of "
                        "half a cell",
                        data.triangles.size());
    else if (!best)
        fault = fmt::format("it is too small to tell maps by: it has fewer than {} cells of {} along its "
                            "longest side",
                            least_voxels, sides.front());
    return best;
}

} // namespace graftal
