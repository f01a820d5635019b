#include "runtime/inverse/found/found_space.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/printable.h"
#include "runtime/inverse/found/start_model.h"
#include "runtime/inverse/found/voxel_target.h"
#include "runtime/system/file.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

/// The target's frame: place = scale * cell + origin.
class SpaceFrame {
  public:
    SpaceFrame(const VoxelTarget& voxels, const SpaceTarget& target)
        : scale_(voxels.cell), origin_(voxels.corner - static_cast<double>(target.room()) * voxels.cell),
          centre_(target.centre()) {}

    /// The map as it is written: the linear part has six digits, and the image of the target's middle is
    /// right to a thousandth of a cell.
    SpaceMap written(const SpaceMap& map) const {
        SpaceMap result = map;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) {
                double& entry = result.linear[column][row];
                entry = std::abs(entry) < 5e-7 ? 0 : with_digits(entry, 6);
            }
        result = result.taking(place(centre_), place(map(centre_)));
        const double unit = 1e-3 * scale_;
        for (int k = 0; k < 3; ++k) {
            double& shift = result.translation[k];
            const double digits = std::ceil(std::log10(std::abs(shift) / unit));
            shift = digits < 1 ? 0 : with_digits(shift, static_cast<int>(std::min(17.0, digits)));
        }
        return result;
    }
    SpaceMap in_cells(const SpaceMap& map) const { return map.taking(centre_, cell(map(place(centre_)))); }

  private:
    Vec3 place(Vec3 cell) const { return origin_ + scale_ * cell; }
    Vec3 cell(Vec3 place) const { return (place - origin_) / scale_; }

    static double with_digits(double value, int digits) {
        std::string text;
        append_number(text, value, digits);
        return parse_number(text).value_or(value);
    }

    double scale_;
    Vec3 origin_, centre_;
};

/// Probabilities by the cells of the images of the target, in thousandths.
std::vector<double> shares_of(const SpaceTarget& target, const SpaceMaps& maps) {
    std::vector<double> shares;
    double sum = 0;
    for (const SpaceMap& map : maps) {
        std::vector<std::size_t> cells;
        for (const Vec3 p : target.points())
            cells.push_back(target.grid().clamped_index(map(p)));
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        sum += shares.emplace_back(static_cast<double>(cells.size()));
    }
    for (double& share : shares)
        share = std::max(0.001, std::round(1000 * share / sum) / 1000);
    return shares;
}

std::string text_of(const FoundSpaceModel& found, const std::vector<double>& shares,
                    const FindSpaceOptions& options) {
    const std::string name = escaped(std::filesystem::path(options.target).filename().string());
    std::string text = fmt::format(
        "# {} map{} that graftal found for the {} {} of {} {}:\n"
        "#   {}\n"
        "# Intersection over union: {:.3f}, within one cell {:.3f}. A cell is {:.6g} wide.\n"
        "# Chamfer distance {:.2f} cells. Contractivity {:.4f}. Bound by the collage theorem: {:.1f} cells.\n"
        "rifs found {{\n  codes 3d {{\n    #  a b c  d e f  g h i  tx ty tz  p\n",
        found.maps.size(), found.maps.size() == 1 ? "" : "s", found.triangles ? "mesh" : "cloud", name,
        found.triangles ? found.triangles : found.points, found.triangles ? "triangles" : "points",
        options.made_by, found.agreement.strict, found.agreement.tolerant, found.cell,
        found.agreement.chamfer, found.contractivity, found.bound);
    for (std::size_t i = 0; i < found.maps.size(); ++i) {
        text += fmt::format("    w{}:", i + 1);
        const SpaceMap& map = found.maps[i];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                text += fmt::format(" {:>10}", shortest(map.linear[column][row]));
        for (int row = 0; row < 3; ++row)
            text += fmt::format(" {:>10}", shortest(map.translation[row]));
        text += fmt::format(" {:>7}\n", shortest(shares[i]));
    }
    return text + "  }\n}\n";
}

std::optional<MeshData> read_target(const std::string& path, std::string& fault, Status& status) {
    std::string bytes;
    status = read_text(path, bytes);
    if (!status.ok()) return std::nullopt;
    return read_mesh_or_cloud(bytes, fault);
}

} // namespace

std::optional<FoundSpaceModel> find_space_model(const FindSpaceOptions& options, const CancelFlag& cancel,
                                                Compilation& compilation) {
    std::string fault;
    const std::optional<MeshData> data = read_target(options.target, fault, compilation.status);
    if (!compilation.status.ok()) return std::nullopt;
    std::optional<VoxelTarget> voxels;
    if (data) voxels = voxels_of(*data, fault);
    if (!voxels) {
        compilation.diagnostics.error({},
                                      fmt::format("the target '{}' is of no use: {}", options.target, fault));
        return std::nullopt;
    }
    const SpaceTarget target(voxels->cells);
    const SpaceFrame frame(*voxels, target);
    SearchOptionsOf<SpaceMap> search_options = options.search;
    const auto start =
        starting_maps(options.start, options.compile, options.search.most_maps, false, compilation);
    if (!start) return std::nullopt;
    for (const Affine& map : *start)
        search_options.start.push_back(ruled(frame.in_cells({map}), target, options.search.rules));
    const WorkerThreads workers(options.threads);
    FoundSystemOf<SpaceMap> system = search(target, search_options, workers, cancel, options.on_progress);

    // The largest image comes first. The numbers are measured as they are written.
    std::stable_sort(system.maps.begin(), system.maps.end(), [](const SpaceMap& a, const SpaceMap& b) {
        return std::abs(a.determinant()) > std::abs(b.determinant());
    });
    FoundSpaceModel found;
    SpaceMaps written;
    for (const SpaceMap& map : system.maps) {
        found.maps.push_back(frame.written(map));
        written.push_back(frame.in_cells(found.maps.back()));
    }
    AttractorPainterOf<SpaceMap> painter(target);
    painter.draw(written);
    found.agreement = painter.agreement_in_full();
    found.contractivity = largest_stretch(found.maps);
    found.epsilon = collage_distance(target, written);
    found.bound = (found.epsilon + 0.5 * std::sqrt(3.0)) / (1 - found.contractivity);
    found.cell = voxels->cell;
    found.cells = voxels->set;
    found.width = voxels->cells.width;
    found.height = voxels->cells.height;
    found.depth = voxels->cells.depth;
    found.points = data->vertices.size();
    found.triangles = data->triangles.size();
    found.seconds = system.seconds;
    found.text = text_of(found, shares_of(target, written), options);
    return found;
}

} // namespace graftal
