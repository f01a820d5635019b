#include "tools/graftal/options.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/importers.h"
#include "compiler/passes/pipeline.h"
#include "compiler/povray/emit/names.h"
#include "compiler/povray/emit/scene.h"
#include "compiler/session/stats.h"
#include "runtime/image_files/image_files.h"
#include "runtime/inverse/blocks/coded_picture.h"
#include "runtime/plants/measures_report.h"
#include "runtime/render/native_engine.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/help/documents.h"
#include "tools/graftal/help/format.h"
#include "tools/graftal/help/usage_errors.h"
#include "tools/graftal/options/animate.h"
#include "tools/graftal/options/editors.h"
#include "tools/graftal/options/export.h"
#include "tools/graftal/options/picture_description.h"
#include "tools/graftal/options/points.h"
#include "tools/graftal/options/refusals.h"
#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/sweep_values.h"
#include "tools/graftal/options/values.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

void add_render(CLI::App& app, Options& options) {
    add_model(app, options);
    app.add_option("-o,--output", options.render.output,
                   "Picture to write, .png or .exr (default: MODEL's name + .png, in this folder)")
        ->type_name("FILE");
    add_view(app, options);
    add_common(app, options);
    add_drawing(app, options);
    app.add_flag_callback(
        "--test-linear", [&] { options.render.format = SampleFormat::linear16; },
        "Write a 16-bit PNG of linear values, for measurements (default: 8-bit sRGB)");
    add_bits(app, options);
    app.add_flag_callback(
        "--progressive", [&options] { options.progressive = true; },
        "Write coarse pictures first, then finer ones under the same name; Ctrl-C keeps the last one "
        "(default, "
        "except with --tile and --engine povray)");
    app.add_flag_callback(
           "--no-progressive", [&options] { options.progressive = false; },
           "Write one picture, when it is finished")
        ->excludes("--progressive");
    add_value(app, "--tile", "X,Y,WxH",
              "Draw only this part of the picture, W by H pixels from X,Y on (0,0 is the top "
              "left); they are those of the whole, to the last bit",
              "a part such as 640,0,640x360", parse_tile,
              [&](const Tile& tile) { options.render.tile = tile; })
        ->needs("--size");
    app.add_flag("--aovs", options.render.aovs,
                 "With an EXR: write the channels A, coverage, Z, normal, albedo, id and "
                 "levels too, and Cryptomatte's mattes of objects, instances and materials");
    app.add_flag(
        "--transparent", options.render.compile.view.transparent,
        "Leave the background clear: alpha is straight in a PNG, premultiplied in an EXR. Haze and the "
        "studio's paper are left out, and a ground is not");
    app.add_flag("--watch", options.watch,
                 "Draw again whenever the model changes or a file that it uses, until "
                 "Ctrl-C");
    app.add_option("--keep", options.render.keep, "Keep POV-Ray's scene and its palettes in this directory")
        ->type_name("DIR");
    app.footer("Examples:\n"
               "  graftal render scenes/hart/pound_sign.rifs            # makes pound_sign.png\n"
               "  graftal render fern.rifs -o fern.exr --size 600x900\n"
               "  graftal render tree.inst --camera \"location=0,2,9 look_at=0,1,0 angle=30\"\n"
               "  graftal render gasket.inst --steps 6 --error 0        # six levels, with every part\n"
               "  graftal print tree.inst | graftal render - -o tree.png\n"
               "  graftal render forest.inst --quality best --size 1920x1080\n"
               "  graftal render fern.rifs --watch                      # and again after each save\n"
               "  graftal render fern.rifs --engine povray              # the same picture by POV-Ray\n"
               "  graftal render tree.inst --aovs -o tree.exr           # depth, normals, ... too\n"
               "  graftal render fern.rifs --size 40000x30000 --tile 0,0,1000x1000");
}

void add_animate(CLI::App& app, Options& options) {
    AnimationOptions& animation = options.animation;
    add_model(app, options);
    app.add_option("-o,--output", options.render.output,
                   "Animation to write, .gif, .png (animated), .mp4 or .webm; .usda: the model itself, as it "
                   "changes; a name without extension is a directory of frames (default: MODEL's name + "
                   ".gif, in this folder)")
        ->type_name("FILE");
    add_value(
        app, "--frames", "N", "Number of frames (default 60)", "a whole number from 1 to 100000",
        [](const std::string& text) { return parse_whole(text, 1, 100'000); },
        [&](std::uint64_t frames) { animation.frames = frames; });
    add_value(app, "--fps", "F", "Frames per second (default 25)", "a number from 0.01 to 240",
              parse_frame_rate, [&](FrameRate rate) { animation.rate = rate; });
    add_value(app, "--turn", "DEGREES",
              "Turn the camera around the model's vertical axis (default: 360 if nothing else moves)",
              "a number from -36000 to 36000", parse_turn, [&](double turn) { animation.turn_deg = turn; });
    add_choice<Ease>(app, "--ease", "Move evenly, or start and end slowly (default linear)",
                     {{"linear", Ease::linear}, {"smooth", Ease::smooth}},
                     [&animation](Ease ease) { animation.ease = ease; });
    add_value(
        app, "--shutter", "SHARE",
        "Motion blur: expose each frame for this share of its time, as 8, 16 or 32 moments by --quality "
        "(default 0: none)",
        "a number from 0 to 1", parse_share, [&animation](double share) { animation.shutter = share; });
    app.add_flag("--keep-frames", animation.keep_frames, "Keep the frames in the directory NAME.frames");
    add_view(app, options);
    add_common(app, options);
    add_drawing(app, options);
    app.footer(
        "A value written A..B runs from A to B over the animation. You can write it for --steps, --seed,\n"
        "--zoom, --set NAME=A..B (NAME=A..B:1 in whole numbers) and the numbers and vectors of --camera.\n"
        "graftal keeps finished frames in NAME.frames until the animation is complete. After an\n"
        "interruption, the same command goes on from there.\n"
        "Examples:\n"
        "  graftal animate scenes/hart/pound_sign.rifs           # once around it: pound_sign.gif\n"
        "  graftal animate plant.lsys --steps 1..12 --frames 48 --fps 12 -o growth.png\n"
        "  graftal animate tree.inst --set a=10..30 --turn 90 --ease smooth -o tree.mp4\n"
        "  graftal animate fern.rifs --camera \"look_at=0,9,0 width=10..0.1\" -o zoom.webm\n"
        "  graftal animate tree.inst --frames 240 -o frames/     # frames/frame_0001.png and so on\n"
        "  graftal animate plant.lsys --steps 1..12 -o growth.usda  # the plant itself, for Blender");
}

void add_compile(CLI::App& app, Options& options) {
    add_model(app, options);
    app.add_option(
           "-o,--output", options.render.output,
           "Scene to write: .pov draws the model, .inc declares it for use in your own scene; graftal "
           "writes palettes beside it (default: the scene on standard output)")
        ->type_name("FILE");
    add_value(
        app, "--name", "NAME",
        "Name that an .inc declares, and that its other names begin with (default: the model's file name)",
        "a name of at most 24 letters, digits and '_' that begins with a capital letter (POV-Ray's own words "
        "do not)",
        [](const std::string& text) -> std::optional<std::string> {
            return is_model_identifier(text) ? std::optional(text) : std::nullopt;
        },
        [&](const std::string& name) { options.identifier = name; });
    add_view(app, options);
    add_common(app, options);
    app.footer("Examples:\n"
               "  graftal compile fern.rifs -o fern.pov && povray +Ifern.pov +W640 +H480\n"
               "  graftal compile fern.rifs -o far_fern.inc --name FarFern --error-world 0.001\n"
               "  graftal compile fern.rifs | less");
}

void add_check(CLI::App& app, Options& options) {
    app.add_option("MODEL", options.operands, "Model files, or - for standard input")
        ->required()
        ->expected(1, -1)
        ->type_name("");
    add_inspecting_work(app, options);
    add_common(app, options);
    app.footer("Example:\n  graftal check scenes/*/*.rifs      # exit status 1 if any model is faulty");
}

void add_stats(CLI::App& app, Options& options) {
    add_model(app, options);
    app.add_flag("--json", options.json, "Print one JSON object on standard output");
    app.add_flag("--boxes", options.boxes,
                 "Count the boxes of a grid that the figure meets, for sides that halve: its box dimension");
    app.add_flag("--plant", options.plant,
                 "Measure the plant of an L-system, in place of the model: lengths, areas, orders, angles")
        ->excludes("--boxes");
    add_value(
        app, "--ground-area", "AREA",
        "With --plant: ground for the leaf area index and the share of light, in square units of the model "
        "(default: the crown's convex hull from above)",
        "a number above 0", [](const std::string& text) { return parse_at_least(text, 1e-100); },
        [&](double area) { options.ground_area = area; })
        ->needs("--plant");
    add_irradiance(app, options);
    app.get_option("--irradiance")->needs("--plant");
    add_inspecting_work(app, options);
    add_common(app, options);
    std::string keys = "Keys:\n";
    for (const StatsKey& key : stats_keys())
        keys += fmt::format("  {:<30} {}\n", key.name, key.meaning);
    keys += "Keys with --plant:\n";
    for (const MeasuresKey& key : measures_keys())
        keys += fmt::format("  {:<30} {}\n", key.name, key.meaning);
    app.footer(keys + "Examples:\n"
                      "  graftal stats scenes/abop/fig2_6a.lsys --plant\n"
                      "  graftal stats scenes/hart/pound_sign.rifs\n"
                      "  graftal stats scenes/ifs/koch_curve.rifs --boxes\n"
                      "  graftal stats scenes/hart/pound_sign.rifs --steps 100 --json | jq -r .primitives");
}

void add_after(CLI::App& app, Options& options, const std::string& verb) {
    add_value(
        app, "--after", "PASS", verb + " the graph as it is after this pass (default: after all passes)",
        "a pass", [](const std::string& text) { return pass_named(text, false); },
        [&](const std::string& pass) { options.render.compile.stop_after = pass; });
}

void add_print(CLI::App& app, Options& options) {
    add_model(app, options);
    add_after(app, options, "Print");
    add_choice<bool>(app, "--as", "Language of the text: inst (default), or rifs: maps and a control digraph",
                     {{"inst", false}, {"rifs", true}}, [&](bool rifs) { options.as_rifs = rifs; });
    app.add_flag_callback(
        "--word", [&options] { options.render.compile.lower.in_place = LowerOptions::InPlace::word; },
        "Print the string that an L-system derives, in place of the graph");
    add_inspecting_work(app, options);
    add_common(app, options);
    app.footer("Examples:\n"
               "  graftal print fern.rifs > fern.inst     # the same model in the instancing language\n"
               "  graftal print scenes/abop/fig1_24a.lsys --word --steps 2\n"
               "  graftal print scenes/limits/tree.lsys --as rifs > tree.rifs\n"
               "  graftal print fern.rifs --after drop_unreachable");
}

void add_graph(CLI::App& app, Options& options) {
    add_model(app, options);
    app.add_option(
           "-o,--output", options.render.output,
           "Drawing of the graph to write: .dot, or .svg by Graphviz (default: DOT on standard output)")
        ->type_name("FILE");
    add_after(app, options, "Draw");
    add_inspecting_work(app, options);
    add_common(app, options);
    app.footer(
        "Examples:\n"
        "  graftal graph pound_sign.rifs -o pound_sign.svg\n"
        "  graftal graph pound_sign.rifs | dot -Tpdf > pound_sign.pdf\n"
        "  graftal graph gasket.inst --after drop_unreachable     # before the merging of equal objects");
}

void add_import(CLI::App& app, Options& options) {
    app.add_option_function<std::string>(
           "FILE", [&options](const std::string& file) { options.operands = {file}; },
           "File of another program, or FILE:NAME for one of its models")
        ->required()
        ->type_name("");
    app.add_option(
           "-o,--output", options.render.output,
           "Model to write, or a folder for all models of FILE, which ends in / (default: a list of the "
           "models; of a single one the text)")
        ->type_name("FILE");
    app.add_option("--root", options.render.compile.lower.root,
                   "Read only files in this folder or below it, of those that FILE names")
        ->type_name("DIR");
    add_seed(app, options);
    app.add_flag("-q,--quiet", options.quiet, "Print only errors and warnings");
    std::string formats = "Formats:\n";
    for (const Importer& importer : importers())
        formats += fmt::format("  {:<20} {}{}\n", importer.format, importer.endings.empty() ? ".txt" : ".",
                               fmt::join(importer.endings, ", ."));
    app.footer(formats +
               "All other commands read these files too: graftal render fractint.l:Koch1\n"
               "Examples:\n"
               "  graftal import fractint.l                   # lists its models\n"
               "  graftal import fractint.l:Koch1 -o koch.lsys\n"
               "  graftal import fractint.l -o models/        # models/Koch1.lsys and all the others");
}

void add_compare(CLI::App& app, Options& options) {
    app.add_option("A B", options.operands, "Two pictures of the same size")
        ->required()
        ->expected(2)
        ->type_name("");
    add_value(
        app, "--threshold", "T", "Largest difference of a sample that still passes, 0..1 (default 0)",
        "a number, 0 or more", [](const std::string& text) { return parse_at_least(text, 0); },
        [&](double threshold) { options.threshold = threshold; });
    app.add_flag("-q,--quiet", options.quiet, "Print no numbers; give only the exit status");
    app.footer(
        "Prints max, mean and rms of |a - b| over all samples, as the files store them (no colour\n"
        "conversion); p99, which 99 of 100 pixels do not exceed; and count, the number of pixels over\n"
        "the threshold. The exit status is 0 if count is 0, 1 if it is not or if the sizes differ, and\n"
        "3 if graftal cannot read a picture.\n"
        "Example:\n  graftal compare before.png after.png --threshold 0.01");
}

void add_points(CLI::App& app, Options& options) {
    add_model(app, options);
    add_points_options(app, options);
    add_camera(app, options);
    add_common(app, options);
}

void add_collage(CLI::App& app, Options& options) {
    add_collage_options(app, options);
    add_camera(app, options);
    app.remove_option(app.get_option("--size")); // the size is the target's
    add_common(app, options);
}

int usage_error(const std::string& message, const std::string& command) {
    complain(message);
    say(fmt::format("Try 'graftal{}{} --help' for more information.\n", command.empty() ? "" : " ", command));
    return exit_usage;
}

std::string passes_text() {
    std::string text = "Before analysis, for all commands:\n";
    const auto add = [&](std::span<const Pass> passes) {
        for (const Pass& pass : passes)
            text += fmt::format("  {:<22} {}\n", pass.name, pass.summary);
    };
    add(model_passes());
    text += "After it, on what is drawn:\n";
    add(detail_passes());
    return text;
}

std::string complete_nothing(Options&) {
    return {};
}

std::string complete_studio(Options& options) {
    options.render.compile.detail.memory_bytes = options.studio.memory_bytes; // the limit of this process
    return {};
}

std::string complete_render(Options& options) {
    std::string& output = options.render.output;
    for (const auto refusal : {refusal_of_engine, refusal_of_size})
        if (std::string refused = refusal(options); !refused.empty()) return refused;
    if (output.empty() && options.operands.front() == "-")
        return "a model from standard input has no name: name the picture with '-o FILE'";
    options.output_is_default = output.empty();
    if (output.empty()) output = model_stem(options.operands.front()) + ".png";
    if (!is_picture_name(output))
        return fmt::format("'{}': the name of a picture must end in .png or .exr", output);
    return {};
}

std::string complete_animate(Options& options) {
    const std::string refused = refusal_of_engine(options);
    return refused.empty() ? complete_animation(options) : refused;
}

/// Without a file's name the output is standard output; else the name must have one of two endings.
std::string complete_text(Options& options, const char* what, const char* one, const char* other) {
    std::string& output = options.render.output;
    if (output.empty()) output = "-";
    const std::string extension = std::filesystem::path(output).extension().string();
    if (output == "-" || extension == one || extension == other) return {};
    return fmt::format("'{}': the name of {} must end in {} or {}", output, what, one, other);
}

std::string complete_compile(Options& options) {
    std::string wrong = complete_text(options, "a scene", ".pov", ".inc");
    if (wrong.empty() && !options.identifier.empty() && !options.render.output.ends_with(".inc"))
        return "--name names what an .inc declares: give '-o FILE.inc' too";
    return wrong;
}

std::string complete_graph(Options& options) {
    return complete_text(options, "a graph's drawing", ".dot", ".svg");
}

constexpr Command commands[] = {
    {"render", "Draw a picture of a model, with graftal's own ray tracer or POV-Ray", add_render,
     complete_render, run_render},
    {"animate", "Make an animation of a model that turns, grows or changes", add_animate, complete_animate,
     run_animate, ".gif", FolderAsOutput::is_written},
    {"points", "Draw a model by random points, as a picture or a point cloud", add_points, complete_points,
     run_points},
    {"collage", "Measure how well a model's maps cover a target picture", add_collage, complete_nothing,
     run_collage},
    {"fit", "Find a model: of a picture's maps, or of a drawing's L-system", add_fit_options, complete_fit,
     run_fit, ".rifs"},
    {"compile", "Write a model as a POV-Ray scene", add_compile, complete_compile, run_compile, ".pov"},
    {"export", "Write a model for other programs: Blender, web pages, printers, renderers", add_export,
     complete_export, run_export, ".glb"},
    {"check", "Check models, and report what is wrong with them", add_check, complete_nothing, run_check},
    {"stats", "Print the sizes, contraction, dimension and bounds of a model", add_stats, complete_nothing,
     run_stats},
    {"print", "Print the graph of a model as .inst text", add_print, complete_nothing, run_print},
    {"graph", "Draw the graph of a model", add_graph, complete_graph, run_graph, ".svg"},
    {"import", "Translate models of other programs into models of graftal", add_import, complete_nothing,
     run_import, ".lsys", FolderAsOutput::holds_files},
    {"compare", "Measure how much two pictures differ", add_compare, complete_nothing, run_compare},
    {"studio", "Open a page to type, drag and see a model", add_studio, complete_studio, run_studio},
    {"format", "Lay out the text of models", add_format, complete_nothing, run_format},
    {"lsp", "Serve an editor: findings, completion, names, layout", add_lsp, complete_nothing, run_lsp},
    {"farm", "Draw gigapixels, films and sweeps in tasks, on many machines", add_farm, complete_farm,
     run_farm, "", FolderAsOutput::is_written},
};

/// The problem with options that are each right, or "".
std::string complete(Options& options) {
    if (std::string refused = refusal_of_folder(options); !refused.empty())
        return refused; // before all that is said of a file's name
    if (std::string refused = options.watch ? refusal_to_watch(options) : ""; !refused.empty())
        return refused;
    if (!options.engine)
        options.engine = find_engine(options.draws && !options.watch ? auto_engine : engines().front().name);
    options.render.progressive = options.progressive.value_or(false);
    std::string problem = options.command->complete(options);
    if (problem.empty()) problem = refusal_of_folder(options); // a name that the model gave
    return problem.empty() ? refusal_of_names(options) : problem;
}

} // namespace

ParsedCommandLine parse_command_line(int argc, const char* const* argv) {
    return parse_command_line(std::vector<std::string>(argv, argv + argc));
}

ParsedCommandLine parse_command_line(std::vector<std::string> words, bool in_parts) {
    Options options;
    options.in_parts = in_parts;
    options.farm.words = take_foreign_words(words);
    std::vector<const char*> argv;
    for (const std::string& word : words)
        argv.push_back(word.c_str());
    const int argc = static_cast<int>(argv.size());
    CLI::App app(
        "graftal compiles small text models of fractals and plants into object-instance graphs, and\n"
        "the graphs into pictures and POV-Ray scenes.",
        "graftal");
    app.formatter(help_formatter());
    app.set_version_flag("--version", "graftal " GRAFTAL_VERSION);
    app.require_subcommand(0, 1); // 'graftal help render' names one command, and explains another
    bool help_passes = false;
    app.add_flag("--help-passes", help_passes, "List the passes of the compiler");
    app.footer(
        "A model is a file .lsys, .rifs or .inst, or of another program: 'graftal import --help' lists "
        "these.\n"
        "'graftal COMMAND --help' explains a command and shows examples. If you are new to graftal, start\n"
        "with docs/tutorial.md.\n"
        "Exit status: 0 success, 1 faulty model or result, 2 wrong command line, 3 faulty environment.");
    for (const Command& row : commands) {
        CLI::App* command = app.add_subcommand(row.name, row.summary);
        row.add(*command, options);
        group_options(*command);
        command->callback([&options, &row] { options.command = &row; });
    }
    const Documents documents(app);

    std::vector<std::string> names;
    for (const Command& row : commands)
        names.emplace_back(row.name);
    std::ranges::copy(Documents::commands(), std::back_inserter(names));
    const std::string wrong = wrong_command(argc, argv.data(), names);
    if (!wrong.empty()) return {std::nullopt, usage_error(wrong, "")};
    const auto chosen = [&]() -> std::string {
        std::string name;
        for (const CLI::App* command = &app; !command->get_subcommands().empty();) {
            command = command->get_subcommands().front();
            name += (name.empty() ? "" : " ") + command->get_name();
        }
        return name;
    };
    const auto chosen_command = [&]() -> const CLI::App& {
        const CLI::App* command = &app;
        while (!command->get_subcommands().empty())
            command = command->get_subcommands().front();
        return *command;
    };
    try {
        app.parse(argc, argv.data());
        if (const std::optional<std::string> text = documents.text())
            return {std::nullopt, print_output(*text)};
    } catch (const CLI::CallForHelp&) {
        const std::string name = chosen();
        const std::string before = name.starts_with("farm ") ? "graftal farm" : "graftal";
        return {std::nullopt, print_output(name.empty() ? app.help() : chosen_command().help(before))};
    } catch (const CLI::CallForVersion& version) {
        return {std::nullopt, print_output(std::string(version.what()) + "\n")};
    } catch (const CLI::ParseError& error) {
        return {std::nullopt, usage_error(usage_message(error, chosen_command()), chosen())};
    }
    if (help_passes) return {std::nullopt, print_output(passes_text())};
    if (chosen().empty()) return {std::nullopt, usage_error("which command?", "")};
    if (chosen() == "farm")
        return {std::nullopt, usage_error("farm: name a step: plan, submit, status, merge or clean", "farm")};
    options.draws = chosen_command().get_option_no_throw("--engine") != nullptr;
    std::string problem = complete(options);
    if (problem.empty() && chosen() == "render" && is_pifs_name(options.operands.front()))
        problem = refusal_of_pifs(chosen_command(), options);
    if (problem.empty() && chosen() == "animate" &&
        animation_kind(options.render.output) == AnimationKind::usd)
        problem = refusal_of_usd(chosen_command());
    if (!problem.empty()) return {std::nullopt, usage_error(problem, chosen())};

    options.animation.identity = frame_identity(*app.get_subcommands().front(), *options.engine);
    options.render.metadata = {"graftal " GRAFTAL_VERSION,
                               picture_description(*app.get_subcommands().front(), *options.engine)};
    return {std::move(options), exit_done};
}

} // namespace graftal
