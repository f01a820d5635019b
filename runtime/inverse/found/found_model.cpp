#include "runtime/inverse/found/found_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/printable.h"
#include "runtime/inverse/found/start_model.h"
#include "runtime/inverse/occupancy.h"
#include "runtime/inverse/target_frame.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

constexpr double half_diagonal = 0.70710678118654752;

double rounded(double value, int digits) {
    std::string text;
    append_number(text, value, digits);
    return parse_number(text).value_or(value);
}

PlaneMap rounded(const PlaneMap& m) {
    const auto six = [](double value) { return std::abs(value) < 5e-7 ? 0.0 : rounded(value, 6); };
    return {six(m.a), six(m.b), six(m.c), six(m.d), six(m.e), six(m.f)};
}

/// Probabilities by the areas of the images (Barnsley 1988), in thousandths.
std::vector<double> probabilities(const PlaneMaps& maps) {
    std::vector<double> shares;
    double largest = 0, sum = 0;
    for (const PlaneMap& map : maps)
        largest = std::max(largest, std::abs(map.determinant()));
    for (const PlaneMap& map : maps)
        sum += shares.emplace_back(std::max(std::abs(map.determinant()), std::max(0.02 * largest, 1e-9)));
    for (double& share : shares)
        share = std::max(0.001, std::round(1000 * share / sum) / 1000);
    return shares;
}

std::string text_of(const FoundModel& found, const TargetPicture& picture, const FindOptions& options) {
    const std::string name = escaped(std::filesystem::path(options.target).filename().string());
    std::string text = fmt::format(
        "# {} map{} that graftal found for the picture {} of {}x{} pixels:\n"
        "#   {}\n"
        "# Intersection over union: {:.3f}, within one cell {:.3f}. A cell is {} pixel{} wide.\n"
        "# Chamfer distance {:.2f} cells. Contractivity {:.4f}. Bound by the collage theorem: {:.1f} cells.\n"
        "# The camera shows the frame of the target: draw with --size {}x{}.\n"
        "rifs found {{\n  codes 2d {{\n    #    a b c d e f p\n",
        found.maps.size(), found.maps.size() == 1 ? "" : "s", name, picture.width, picture.height,
        options.made_by, found.agreement.strict, found.agreement.tolerant, shortest(found.cell),
        found.cell == 1 ? "" : "s", found.agreement.chamfer, found.contractivity, found.bound, picture.width,
        picture.height);
    const auto level = [](double value) { return shortest(std::round(1000 * value) / 1000); };
    const std::vector<double> chances = probabilities(found.maps);
    for (std::size_t i = 0; i < found.maps.size(); ++i) {
        const PlaneMap& m = found.maps[i];
        text += fmt::format("    w{}:", i + 1);
        for (const double value : {m.a, m.b, m.c, m.d, m.e, m.f, chances[i]})
            text += fmt::format(" {:>10}", shortest(value));
        if (found.colours) {
            const Rgb& rgb = found.colours->of_map[i];
            text += fmt::format("   tint rgb <{}, {}, {}> {}", level(rgb.r), level(rgb.g), level(rgb.b),
                                shortest(found.colours->alpha));
        }
        text += "\n";
    }
    text += fmt::format("  }}\n}}\ncamera {{ orthographic  look_at: 0.5, {}, 0  width: 1 }}\n",
                        shortest(rounded(0.5 * picture.height / picture.width, 6)));
    return text;
}

/// The mean colours of the target's points, in their order.
std::vector<Rgb> colours_of(const Target& target, const TargetPicture& picture, const Crop& crop) {
    std::vector<Rgb> sums(crop.set.cells.size(), Rgb(0.0));
    std::vector<double> pixels(crop.set.cells.size());
    for (int y = 0; y < picture.cells.height; ++y)
        for (int x = 0; x < picture.cells.width; ++x) {
            if (!picture.cells.at(x, y)) continue;
            const std::size_t cell = crop.set.index((x - crop.left) / crop.size, (y - crop.top) / crop.size);
            sums[cell] += picture.colours[picture.cells.index(x, y)];
            pixels[cell] += picture.pixels[picture.cells.index(x, y)];
        }
    std::vector<Rgb> colours;
    for (const Vec2 p : target.points()) {
        const std::size_t cell =
            crop.set.index(static_cast<int>(p.x) - target.room(), static_cast<int>(p.y) - target.room());
        colours.push_back(sums[cell] / pixels[cell]);
    }
    return colours;
}

/// Maps of a model to begin with, in cells.
std::optional<PlaneMaps> start_of(const FindOptions& options, const TargetFrame& frame, const Target& target,
                                  Compilation& compilation) {
    const auto known =
        starting_maps(options.start, options.compile, options.search.most_maps, true, compilation);
    if (!known) return std::nullopt;
    PlaneMaps maps;
    for (const Affine& map : *known) {
        const Mat3& m = map.linear;
        const Vec3& t = map.translation;
        maps.push_back(ruled(frame.in_cells({m[0][0], m[1][0], m[0][1], m[1][1], t.x, t.y}), target,
                             options.search.rules));
    }
    return maps;
}

} // namespace

std::optional<FoundModel> find_model(const FindOptions& options, const CancelFlag& cancel,
                                     Compilation& compilation) {
    TargetPicture picture;
    compilation.status =
        read_target(options.target, options.criterion, picture, most_read_cells_a_side, options.in_colour);
    if (!compilation.status.ok()) return std::nullopt;
    if (picture.empty()) {
        compilation.diagnostics
            .error({}, empty_target_text(options.target, options.criterion, picture.by_alpha))
            .with_hint("choose other pixels by --threshold or --light");
        return std::nullopt;
    }
    const Crop crop = cropped(picture.cells);
    const auto cells =
        static_cast<std::size_t>(std::count(crop.set.cells.begin(), crop.set.cells.end(), true));
    if (cells < least_target_cells) {
        compilation.diagnostics
            .error({}, fmt::format(
                           "the target '{}' is too small to tell maps by: only {} of its {}x{} pixels "
                           "{} {}",
                           options.target, cells, picture.width, picture.height, cells == 1 ? "is" : "are",
                           criterion_text(options.criterion, picture.by_alpha)))
            .with_hint(
                fmt::format("a figure has at least {} such pixels: draw it larger, take paler pixels by "
                            "--threshold 0.8, or the light ones by --light",
                            least_target_cells));
        return std::nullopt;
    }
    const Target target(crop.set);
    const TargetFrame frame({picture.width, picture.height, picture.pixels_per_cell}, crop, target.room());
    SearchOptions search_options = options.search;
    std::optional<PlaneMaps> start = start_of(options, frame, target, compilation);
    if (!start) return std::nullopt;
    search_options.start = std::move(*start);
    FoundSystem system =
        (options.occupancy ? search_occupancy : search<PlaneMap>)(target, search_options,
                                                                  WorkerThreads(options.threads), cancel,
                                                                  options.on_progress);

    // The largest image comes first. The numbers are measured as they are written.
    std::stable_sort(system.maps.begin(), system.maps.end(), [](const PlaneMap& a, const PlaneMap& b) {
        return std::abs(a.determinant()) > std::abs(b.determinant());
    });
    FoundModel found;
    PlaneMaps written;
    for (const PlaneMap& map : system.maps) {
        found.maps.push_back(rounded(frame.in_model(map)));
        written.push_back(frame.in_cells(found.maps.back()));
    }
    AttractorPainter painter(target, options.occupancy ? occupancy_parts(target) : 2);
    painter.draw(written);
    found.agreement = painter.agreement_in_full();
    if (options.in_colour) found.colours = fit_colours(target, written, colours_of(target, picture, crop));
    found.contractivity = largest_stretch(found.maps);
    found.epsilon = collage_distance(target, written);
    found.bound = (found.epsilon + half_diagonal) / (1 - found.contractivity);
    found.cell = static_cast<double>(crop.size) * picture.pixels_per_cell;
    found.cells = cells;
    found.width = crop.set.width;
    found.height = crop.set.height;
    found.seconds = system.seconds;
    found.by_alpha = picture.by_alpha;
    found.text = text_of(found, picture, options);
    return found;
}

} // namespace graftal
