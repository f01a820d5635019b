#include "tools/graftal/options/export.h"

#include <algorithm>

#include "compiler/support/number.h"
#include "compiler/support/number_range.h"
#include "runtime/export/plant_files.h"
#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/values.h"

namespace graftal {

namespace {

/// "25.4mm", "1cm", "2m", "1in": what it is in millimetres.
std::optional<double> parse_length_mm(const std::string& text) {
    struct Unit {
        const char* name;
        double mm;
    };
    constexpr Unit units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}}; // "mm" before "m"
    for (const Unit& unit : units) {
        if (!text.ends_with(unit.name)) continue;
        const auto number =
            parse_number(std::string_view(text).substr(0, text.size() - std::string_view(unit.name).size()));
        if (!number || !(*number > 0) || !is_size(*number * unit.mm)) return std::nullopt;
        return *number * unit.mm;
    }
    return std::nullopt;
}

std::string formats_text() {
    std::string text = "Formats, by the ending of FILE:\n";
    for (const ExportFormat& format : export_formats())
        text += fmt::format("  {:<6} {}: {}\n", format.extension, format.name, format.summary);
    return text +
           fmt::format("  {} the modules of an L-system as data, with parents and places\n", plant_endings());
}

} // namespace

void add_export(CLI::App& app, Options& options) {
    ExportOptions& file = options.file;
    add_model(app, options);
    app.add_option("-o,--output", options.render.output,
                   fmt::format("File to write, {}; the modules of an L-system as data: {}", export_endings(),
                               plant_endings()))
        ->type_name("FILE");
    add_bytes(app, "--limit",
              "Largest file; suffixes K M G (default 1G). If the whole model takes more, graftal leaves out "
              "small parts until the file is no larger (by default 128M). With --error it refuses",
              [&file](std::uint64_t bytes) { file.most_bytes = file.fitted_bytes = bytes; });
    add_value(app, "--unit", "LENGTH",
              fmt::format("What a unit of the model measures, such as 25mm, 1cm, 2m or 1in ({}; default: "
                          "that of the format)",
                          endings_with(&ExportFormat::has_unit)),
              "a length such as 25mm, 1cm, 2m or 1in", parse_length_mm,
              [&file](double unit_mm) { file.unit_mm = unit_mm; });
    add_value(
        app, "--levels", "N",
        fmt::format("Levels of instances within instances, for programs that show no more ({}; Blender: 7, "
                    "RenderMan: 4; default: as many as the model has)",
                    endings_with(&ExportFormat::has_levels)),
        "a whole number from 2 to 1000", [](const std::string& text) { return parse_whole(text, 2, 1000); },
        [&file](std::uint64_t levels) { file.levels = static_cast<unsigned>(levels); });
    add_value(
        app, "--nodes", "N",
        fmt::format("Nodes that a file may have; graftal makes one mesh of parts where there are more "
                    "({}; default {})",
                    endings_with(&ExportFormat::has_nodes), ExportOptions::default_nodes),
        "a whole number from 1 to 10000000",
        [](const std::string& text) { return parse_whole(text, 1, 10'000'000); },
        [&file](std::uint64_t nodes) { file.nodes = nodes; });
    app.add_flag(
        "--instancing", file.instancing,
        fmt::format("Write one node a mesh, with a table of its places (EXT_mesh_gpu_instancing; {})",
                    endings_with(&ExportFormat::has_instancing)));
    app.add_option(
           "--part", file.parts,
           fmt::format("Keep each object of this name a mesh of its own, in a node of its own, such as the "
                       "leaves of a tree; '*' keeps all apart; may repeat ({})",
                       endings_with(&ExportFormat::has_parts)))
        ->type_name("NAME")
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_flag("--plotter", file.plotter,
                 fmt::format("Draw each line once, with a pen that is lifted as little as may be ({})",
                             endings_with(&ExportFormat::has_plotter)));
    add_irradiance(app, options);
    add_work(app, options,
             fmt::format("Limit of the work for {}, roughly in seconds of one processor (default {:g}); with "
                         "--irradiance as much again, for the light",
                         plant_endings(), inspecting_seconds));
    add_camera(app, options);
    add_error(app, options);
    add_plain_light(app, options);
    add_common(app, options);
    app.footer(formats_text() +
               "graftal writes a model that ends whole, and one without end to its --steps. A model without\n"
               "either ends where parts are smaller than --error in the picture, or than --error-world; the\n"
               "same leaves out parts of the others. If that makes too large a file, and you give neither,\n"
               "graftal leaves out larger parts, and says how large.\n"
               "Examples:\n"
               "  graftal export tree.lsys -o tree.obj\n"
               "  graftal export sponge.rifs --steps 3 --unit 20mm -o sponge.stl\n"
               "  graftal export fern.rifs --error 2 -o fern.ply\n"
               "  graftal export plant.lsys -o plant.csv                # its modules, for R or pandas\n"
               "  graftal export plant.lsys --irradiance -o plant.csv   # and the light on each");
}

std::string complete_export(Options& options) {
    if (options.render.output.empty())
        return fmt::format("name the file with '-o FILE'; its ending says the format: {}; {}",
                           export_endings(), plant_endings());
    const ExportFormat* const format = find_export_format(options.render.output);
    if (!format) {
        const PlantFormat* const plant = find_plant_format(options.render.output);
        if (!plant)
            return fmt::format("'{}': the name must end in {}; {}", options.render.output, export_endings(),
                               plant_endings());
        const bool finds_parts = options.error_asked || options.render.compile.view.zoom.active();
        const std::string problem = refusal_of_plant_options(*plant, options.file, finds_parts);
        return problem.empty() ? "" : "--" + problem;
    }
    if (options.irradiance)
        return fmt::format("--irradiance is for {}, not for {}", plant_endings(), format->extension);
    if (const ExportWish* const wish = find_vain_wish(*format, options.file))
        return fmt::format("--{} is for {}, not for {}", wish->option, endings_with(wish->has),
                           format->extension);
    return {};
}

ExportModelOptions export_options(const Options& options) {
    ExportModelOptions wanted;
    wanted.compile = options.render.compile;
    wanted.error_asked = options.error_asked;
    wanted.file = options.file;
    wanted.file.memory_bytes = options.render.compile.detail.memory_bytes;
    wanted.file.output = options.render.output;
    wanted.file.metadata = options.render.metadata;
    return wanted;
}

} // namespace graftal
