#include "tools/graftal/shared_options.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <vector>

#include "compiler/passes/pipeline.h"
#include "compiler/support/number_range.h"
#include "tools/graftal/option_values.h"
#include "tools/graftal/sweep_values.h"
#include "tools/graftal/usage_errors.h"

namespace graftal {

namespace {

/// Only an animation has values that run from A to B.
bool can_sweep(const CLI::App& app) {
    return app.get_name() == "animate";
}

/// add_value for what an animation may sweep; `read_sweep` reads "A..B".
template<typename Read, typename ReadSweep, typename Store>
void add_swept(CLI::App& app, Options& options, const std::string& name, const std::string& value_name,
               const std::string& help, const std::string& expected, Read read, ReadSweep read_sweep,
               Store store) {
    if (!can_sweep(app)) {
        add_value(app, name, value_name, help, expected, read, store);
        return;
    }
    const auto read_either = [=, &options](const std::string& text) -> std::optional<std::function<void()>> {
        if (auto value = read(text)) return [=] { store(*value); };
        if (auto sweep = read_sweep(text))
            return [=, &options] { add_sweep(options.animation.sweeps, *sweep); };
        return std::nullopt;
    };
    add_value(app, name, value_name + "[.." + value_name + "]", help, expected + ", or two as A..B",
              read_either, [](const std::function<void()>& set) { set(); });
}

} // namespace

std::optional<std::string> pass_named(const std::string& text, bool all_allowed) {
    if (all_allowed && text == "all") return text;
    std::vector<std::string> names;
    for (const Pass& pass : model_passes())
        names.emplace_back(pass.name);
    if (all_allowed)
        for (const Pass& pass : detail_passes())
            names.emplace_back(pass.name);
    if (std::find(names.begin(), names.end(), text) != names.end()) return text;
    throw CLI::ValidationError(fmt::format("there is no pass '{}' ({})", text, choices(text, names)));
}

void add_common(CLI::App& app, Options& options) {
    StageOptions& compile = options.compile;
    constexpr std::uint64_t most_steps = 4'000'000'000;
    add_swept(
        app, options, "--steps", "N",
        "Depth: levels of the recursion, derivation steps of an L-system; 7.3: a growing one between two",
        "a number from 0 to 4000000000",
        [](const std::string& text) { return parse_steps(text, most_steps); },
        [](const std::string& text) { return parse_steps_sweep(text, most_steps); },
        [&](const StepsValue& steps) {
            compile.lower.steps.reset();
            compile.lower.time.reset();
            if (steps.whole)
                compile.lower.steps = static_cast<unsigned>(*steps.whole);
            else
                compile.lower.time = steps.time;
        });
    const bool sweeps = can_sweep(app);
    const auto set = [&options, &compile, sweeps](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            if (const auto sweep = sweeps ? parse_setting_sweep(text) : std::nullopt) {
                add_sweep(options.animation.sweeps, *sweep);
                continue;
            }
            const auto setting = parse_setting(text);
            if (!setting)
                throw CLI::ValidationError(fmt::format("--set: '{}' is not of the form NAME=NUMBER{}", text,
                                                       sweeps ? " or NAME=A..B[:STEP]" : ""));
            drop_sweep(options.animation.sweeps, "--set " + setting->first);
            compile.lower.set[setting->first] = setting->second;
        }
    };
    app.add_option_function<std::vector<std::string>>("--set", set,
                                                      "Replace the value of a 'let' of the model, or of a "
                                                      "setting: steps; of an .lsys also angle, step, width, "
                                                      "seed (may be repeated)")
        ->allow_extra_args(false)
        ->type_name(sweeps ? "NAME=VALUE[..VALUE[:STEP]]" : "NAME=VALUE");
    add_swept(
        app, options, "--seed", "N", "Seed of random models", "a whole number",
        [](const std::string& text) { return parse_whole(text, 0, UINT64_MAX); }, parse_seed_sweep,
        [&](std::uint64_t seed) { compile.lower.seed = seed; });
    add_value(
        app, "--root", "FOLDER",
        "Read models, and the models and pictures that they name, in this folder only, wherever symbolic "
        "links lead",
        "a folder",
        [](const std::string& text) {
            std::error_code error;
            return std::filesystem::is_directory(text, error) ? std::optional(text) : std::nullopt;
        },
        [&](const std::string& root) { compile.lower.root = root; });
    app.add_flag("--exact", compile.lower.exact,
                 "Derive L-systems module by module, so that a random one is one honest sample");
    add_value(app, "--memory", "BYTES",
              "Memory that graftal may take, and POV-Ray after it; suffixes K M G (default 2G)",
              "a number of bytes such as 512M", parse_bytes,
              [&](std::uint64_t bytes) { compile.detail.memory_bytes = bytes; });
    add_value(
        app, "--threads", "N", "Threads to use (default: all processors)", "a whole number from 1 to 512",
        [](const std::string& text) { return parse_whole(text, 1, 512); },
        [&](std::uint64_t threads) { options.threads = static_cast<int>(threads); });
    add_value(
        app, "--dump-after", "PASS", "Print the graph on standard error after this pass, or after 'all'",
        "a pass", [](const std::string& text) { return pass_named(text, true); },
        [&](const std::string& pass) { options.dump_after = pass; });
    app.add_flag("--time", options.time, "Print the time of each stage on standard error");
    app.add_flag("-q,--quiet", options.quiet, "No progress and no summary; errors and warnings only");
}

void add_camera(CLI::App& app, Options& options) {
    StageOptions& compile = options.compile;
    add_value(app, "--size", "WxH", "Size of the picture in pixels (default 1280x720)",
              "a size such as 1280x720, at most 32768 a side", parse_size,
              [&](ImageSize size) { compile.view.size = size; });
    const auto camera = [&compile, &sweeps = options.animation.sweeps,
                         swept = can_sweep(app)](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            const std::string problem = swept ? parse_camera_sweeps(text, compile.view.camera, sweeps)
                                              : parse_camera(text, compile.view.camera);
            if (!problem.empty()) throw CLI::ValidationError("--camera: " + problem);
        }
    };
    app.add_option_function<std::vector<std::string>>(
           "--camera", camera,
           "Camera: any of location=X,Y,Z look_at=X,Y,Z up=X,Y,Z angle=DEGREES orthographic width=UNITS; the "
           "rest is as the model says or automatic")
        ->allow_extra_args(false)
        ->type_name("\"WORDS\"");
    const auto address = [&compile](const std::string& text) {
        std::string problem;
        compile.view.zoom.at = parse_address(text, problem);
        if (!compile.view.zoom.at) throw CLI::ValidationError(fmt::format("--at: '{}': {}", text, problem));
    };
    app.add_option_function<std::string>("--at", address,
                                         "Look at the part with this address, from its own frame: names of "
                                         "objects on the way from the root, "
                                         "such as up.left.(right.up)*40; X#2 is the second instance of X")
        ->type_name("ADDRESS")
        ->take_last();
    add_swept(app, options, "--zoom", "F",
              "Enlarge F times, such as 1e100 or 2^330, about the part at --at, else the point looked at",
              "a number above 0, such as 1e100 or 2^330", Magnification::parse, parse_zoom_sweep,
              [&](Magnification zoom) { compile.view.zoom.zoom = zoom; });
}

void add_view(CLI::App& app, Options& options) {
    add_camera(app, options);
    StageOptions& compile = options.compile;
    CLI::Option* pixels = add_value(
        app, "--error", "PX", "Leave out what is smaller than this on the picture (default 0.5; 0: nothing)",
        "a number of pixels, 0 or more", [](const std::string& text) { return parse_at_least(text, 0); },
        [&](double error) { compile.detail.error_px = error; });
    add_value(
        app, "--error-world", "X", "The same as a length in the model's units",
        "0, or a length from 1e-100 to 1e100",
        [](const std::string& text) {
            const std::optional<double> error = parse_at_least(text, 0);
            return error && (*error == 0 || is_size(*error)) ? error : std::nullopt;
        },
        [&](double error) { compile.detail.error_world = error; })
        ->excludes(pixels);
    add_value(
        app, "--work", "SECONDS",
        "Work for the picture, about so many seconds of one processor; what takes more is drawn coarser "
        "(default 40)",
        "a number of seconds above 0", [](const std::string& text) { return parse_at_least(text, 1e-3); },
        [&](double seconds) { compile.detail.work_seconds = seconds; });
    app.add_flag("--visible-only", compile.detail.visible_only,
                 "Leave out what the camera does not see, with the shadows that it would throw");
    app.add_flag("--flatten", compile.cut.flatten,
                 "Spell out every part in its place, without sharing (for comparison)");
}

void add_model(CLI::App& app, Options& options) {
    const auto set = [&options](const std::string& model) { options.operands = {model}; };
    const std::string help = "Model file (.lsys, .rifs, .inst)";
    app.add_option_function<std::string>("MODEL", set,
                                         can_sweep(app) ? help : help + ", or - for standard input")
        ->required()
        ->type_name("");
}

void add_drawing(CLI::App& app, Options& options) {
    const auto engine = [&options](const std::string& text) {
        if (text != "povray" && text != "native")
            throw CLI::ValidationError(fmt::format("--engine: '{}' is neither povray nor native", text));
        options.engine = text == "native" ? Engine::native : Engine::povray;
    };
    app.add_option_function<std::string>(
           "--engine", engine, "What draws: povray, or graftal's own ray tracer, native (default povray)")
        ->type_name("povray|native")
        ->take_last();
    app.add_flag("--unconfined", options.unconfined,
                 "Let POV-Ray read and write all that you can, with your environment and without limits: for "
                 "programs that start it somewhere else");
    const auto antialias = [&options](const std::string& text) {
        const auto depth = parse_whole(text, 1, 9);
        if (!depth && text != "off")
            throw CLI::ValidationError(
                fmt::format("--antialias: '{}' is neither 'off' nor a whole number from 1 to 9", text));
        options.antialias = depth ? std::optional(static_cast<int>(*depth)) : std::nullopt;
    };
    app.add_option_function<std::string>("--antialias", antialias,
                                         "Smooth edges by up to 4^(N-1) samples a pixel, or off (default 2)")
        ->type_name("off|N")
        ->take_last();
}

} // namespace graftal
