#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/primitives/mesh_file.h"
#include "runtime/inverse/found/found_model.h"
#include "runtime/inverse/found/found_space.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/lsystem/found_lsystem.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/fit_answer.h"
#include "tools/graftal/progress_bar.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

/// The options that pictures share with clouds and meshes.
template<typename Find> Find find_options(const Options& options) {
    Find find;
    find.target = options.points.target;
    find.search.most_maps = options.fit.most_maps;
    find.search.rules.similar = options.fit.similar;
    find.search.seconds = options.render.work_seconds.value_or(find.search.seconds);
    find.search.seed = options.render.compile.lower.seed.value_or(find.search.seed);
    find.start = options.fit.start;
    find.compile = inspecting(options, true);
    find.made_by = options.render.metadata.description;
    find.threads = options.render.threads;
    return find;
}

/// The numbers of a model in the plane or in space.
template<typename Found> Json found_json(const Options& options, const Found& found, Json maps) {
    return {{"target", options.points.target},
            {"model", options.render.output},
            {"target_cells", found.cells},
            {"maps", std::move(maps)},
            {"iou", found.agreement.strict},
            {"iou_within_a_cell", found.agreement.tolerant},
            {"chamfer_cells", found.agreement.chamfer},
            {"contractivity", found.contractivity},
            {"epsilon_cells", found.epsilon},
            {"bound_cells", found.bound},
            {"work_seconds", found.seconds}};
}

Json fit_json(const Options& options, const FoundModel& found) {
    Json maps = Json::array();
    for (const PlaneMap& m : found.maps)
        maps.push_back({m.a, m.b, m.c, m.d, m.e, m.f});
    Json json = found_json(options, found, std::move(maps));
    json["cell_pixels"] = found.cell;
    if (!found.colours) return json;
    Json tints = Json::array();
    for (const Rgb& rgb : found.colours->of_map)
        tints.push_back({rgb.r, rgb.g, rgb.b, found.colours->alpha});
    json["tints"] = std::move(tints);
    json["colour_rms_255"] = found.colours->rms_255;
    return json;
}

/// The report on a model in the plane or in space.
template<typename Found>
std::string found_text(const Options& options, const Found& found, const std::string& target,
                       const std::string& colours) {
    return fmt::format(
        "{}: {} maps, each shortens to {:.4f} or less, so the model is proven to contract\n"
        "agreement      IoU {:.3f}, within one cell {:.3f}; Chamfer distance {:.2f} cells\n"
        "target         {} cells in {}\n"
        "collage        epsilon {:.2f} cells; the attractor is at most {:.1f} cells from the target\n"
        "{}work           {:.1f} s, counted\n",
        options.render.output, found.maps.size(), found.contractivity, found.agreement.strict,
        found.agreement.tolerant, found.agreement.chamfer, found.cells, target, found.epsilon, found.bound,
        colours, found.seconds);
}

std::string fit_text(const Options& options, const FoundModel& found) {
    return found_text(options, found,
                      fmt::format("{}x{}: those with pixels {}; a cell is {:g} pixel{} wide", found.width,
                                  found.height, criterion_text(options.points.criterion, found.by_alpha),
                                  found.cell, found.cell == 1 ? "" : "s"),
                      found.colours
                          ? fmt::format("colours        {:.1f} of 255 from the target's, root mean square\n",
                                        found.colours->rms_255)
                          : "");
}

Json space_json(const Options& options, const FoundSpaceModel& found) {
    Json maps = Json::array();
    for (const SpaceMap& map : found.maps) {
        Json row = Json::array();
        for (int k = 0; k < 9; ++k)
            row.push_back(map.linear[k % 3][k / 3]);
        for (int k = 0; k < 3; ++k)
            row.push_back(map.translation[k]);
        maps.push_back(std::move(row));
    }
    Json json = found_json(options, found, std::move(maps));
    json["cell"] = found.cell;
    return json;
}

std::string space_text(const Options& options, const FoundSpaceModel& found) {
    return found_text(options, found,
                      fmt::format("{}x{}x{}: those with {}; a cell is {:.4g} wide", found.width, found.height,
                                  found.depth,
                                  found.triangles ? fmt::format("parts of {} triangles", found.triangles)
                                                  : fmt::format("some of {} points", found.points),
                                  found.cell),
                      "");
}

Json lsystem_json(const Options& options, const FoundLsystem& found) {
    return {{"target", options.points.target},
            {"model", options.render.output},
            {"lines", found.strokes},
            {"redrawn", found.redrawn},
            {"farthest_units", found.farthest},
            {"letters", found.letters},
            {"steps", found.steps},
            {"angle_deg", found.angle_deg},
            {"factor", found.factor},
            {"work_seconds", found.seconds}};
}

std::string lsystem_report(const Options& options, const FoundLsystem& found) {
    return fmt::format("{}: an L-system of {} letters, for {} lines\n"
                       "agreement      it draws {} of {} lines, no farther than {:.2g} units away\n"
                       "drawing        angle {:g}, {} steps{}\n"
                       "work           {:.1f} s, counted\n",
                       options.render.output, found.letters, found.strokes, found.redrawn, found.strokes,
                       found.farthest, found.angle_deg, found.steps,
                       found.factor == 1 ? "" : fmt::format(", lengths by {:g} a step", found.factor),
                       found.seconds);
}

int run_fit_lsystem(const Options& options) {
    ProgressBar bar(!options.quiet);
    FindLsystemOptions find;
    find.drawing = options.points.target;
    find.tolerance = options.fit.tolerance.value_or(find.tolerance);
    find.seconds = options.render.work_seconds.value_or(find.seconds);
    find.compile = inspecting(options, true);
    find.made_by = options.render.metadata.description;
    find.on_progress = [&](double share, int round) {
        bar.show("searching", share, fmt::format(", round {}", round + 1));
    };
    Compilation compilation;
    const Interruption interruption;
    const std::optional<FoundLsystem> found = find_lsystem(find, interruption.flag(), compilation);
    bar.clear();
    return answer_fit(options, found, lsystem_json, lsystem_report, interruption, compilation);
}

} // namespace

int run_fit(const Options& options) {
    const std::string& target = options.points.target;
    if (options.fit.blocks) return run_fit_blocks(options);
    if (is_drawing_name(target)) return run_fit_lsystem(options);
    ProgressBar bar(!options.quiet);
    const auto on_progress = [&](const SearchProgress& progress) {
        bar.show("searching", progress.fraction,
                 fmt::format(", {} maps, agreement {:.3f}", progress.maps, progress.tolerant));
    };
    Compilation compilation;
    const Interruption interruption;
    if (is_mesh_name(target)) {
        auto find = find_options<FindSpaceOptions>(options);
        find.on_progress = on_progress;
        const auto found = find_space_model(find, interruption.flag(), compilation);
        bar.clear();
        return answer_fit(options, found, space_json, space_text, interruption, compilation);
    }
    auto find = find_options<FindOptions>(options);
    find.criterion = options.points.criterion;
    find.occupancy = options.fit.occupancy;
    find.in_colour = options.fit.in_colour;
    find.on_progress = on_progress;
    const auto found = find_model(find, interruption.flag(), compilation);
    bar.clear();
    return answer_fit(options, found, fit_json, fit_text, interruption, compilation);
}

} // namespace graftal
