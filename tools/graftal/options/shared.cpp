#include "tools/graftal/options/shared.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <sstream>
#include <vector>

#include "compiler/import/importers.h"
#include "compiler/passes/pipeline.h"
#include "compiler/support/number_range.h"
#include "compiler/support/printable.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/plants/plant_light.h"
#include "runtime/render/povray_engine.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/help/usage_errors.h"
#include "tools/graftal/options/sweep_values.h"
#include "tools/graftal/options/values.h"

namespace graftal {

namespace {

void add_devices(CLI::App& app, Options& options) {
    const auto read = [](const std::string& text) -> std::optional<std::vector<std::size_t>> {
        std::vector<std::size_t> numbers;
        std::istringstream words(text + ',');
        for (std::string word; std::getline(words, word, ',');) {
            const std::optional<std::uint64_t> number = parse_whole(word, 0, UINT32_MAX);
            if (!number) return std::nullopt;
            numbers.push_back(*number);
        }
        return numbers;
    };
    add_value(
        app, "--device", "N[,N...]",
        "Graphics cards of '--engine gpu', by their numbers in 'graftal version --json', which share the "
        "picture (default: the first card, and all that have its name)",
        "a list of whole numbers, such as 0 or 0,1", read,
        [&options](std::vector<std::size_t> devices) { options.render.devices = std::move(devices); });
}

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

/// The bytes of the option `name`; nothing for what is no number of them. A usage error where the unit is
/// forgotten.
std::optional<std::uint64_t> sensible_bytes(const std::string& name, const std::string& text) {
    constexpr std::uint64_t least_without_unit = 1u << 20;
    const std::optional<std::uint64_t> bytes = parse_bytes(text);
    const bool has_unit = text.find_first_not_of("0123456789") != std::string::npos;
    if (!bytes || has_unit || *bytes >= least_without_unit) return bytes;
    throw CLI::ValidationError(fmt::format(
        "{}: '{}' is {} byte{}: give a unit, such as {}", name, text, *bytes, *bytes == 1 ? "" : "s",
        *bytes < 1024 ? fmt::format("{0}M or {0}G", *bytes) : fmt::format("{}K", *bytes >> 10)));
}

} // namespace

std::string model_file_help(const std::string& more) {
    std::vector<std::string> endings;
    for (const Importer& importer : importers())
        for (const std::string_view ending : importer.endings)
            if (std::ranges::find(endings, ending) == endings.end()) endings.emplace_back(ending);
    return fmt::format(
        "Model file (.lsys, .rifs, .inst{}; of other programs .{}: see 'graftal import --help')", more,
        fmt::join(endings, ", ."));
}

void add_bytes(CLI::App& app, const std::string& name, const std::string& help,
               const std::function<void(std::uint64_t)>& store) {
    add_value(
        app, name, "BYTES", help, "a number of bytes such as 512M",
        [name](const std::string& text) { return sensible_bytes(name, text); }, store);
}

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

void add_seed(CLI::App& app, Options& options) {
    add_swept(
        app, options, "--seed", "N", "Seed of random models", "a whole number",
        [](const std::string& text) { return parse_whole(text, 0, UINT64_MAX); }, parse_seed_sweep,
        [&](std::uint64_t seed) { options.render.compile.lower.seed = seed; });
}

void add_common(CLI::App& app, Options& options) {
    StageOptions& compile = options.render.compile;
    constexpr std::uint64_t most_steps = 4'000'000'000;
    add_swept(
        app, options, "--steps", "N",
        "Depth: levels of recursion, or derivation steps of an L-system; 7.3 shows a growing plant between "
        "steps 7 and 8",
        "a number from 0 to 4000000000",
        [](const std::string& text) {
            if (text == "infinite")
                throw CLI::ValidationError(
                    "--steps: 'infinite' is for the model's file: write 'steps infinite' into its 'lsys' "
                    "block; other models go on without end unless steps are given");
            return parse_steps(text, most_steps);
        },
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
                                                      "Replace the value of a 'let' in the model, or of the "
                                                      "setting steps; in an .lsys also of angle, step, width "
                                                      "and seed (may be repeated)")
        ->allow_extra_args(false)
        ->type_name(sweeps ? "NAME=VALUE[..VALUE[:STEP]]" : "NAME=VALUE");
    app.add_option("--preset", compile.lower.preset,
                   "Set what this 'preset' of the model sets; --set comes before it")
        ->type_name("NAME");
    add_seed(app, options);
    add_value(
        app, "--root", "FOLDER",
        "Read models, and the models and pictures that they name, only from this folder; graftal resolves "
        "symbolic links first",
        "a folder",
        [](const std::string& text) {
            std::error_code error;
            return std::filesystem::is_directory(text, error) ? std::optional(text) : std::nullopt;
        },
        [&](const std::string& root) { compile.lower.root = root; });
    app.add_flag("--exact", compile.lower.exact,
                 "Derive L-systems module by module, so that a random plant is one true random sample");
    add_bytes(app, "--memory",
              "Memory that graftal may use, and POV-Ray after it; suffixes K M G (default 2G)",
              [&](std::uint64_t bytes) { compile.detail.memory_bytes = bytes; });
    add_value(
        app, "--threads", "N", "Number of threads (default: one per processor)",
        "a whole number from 1 to 512", [](const std::string& text) { return parse_whole(text, 1, 512); },
        [&](std::uint64_t threads) { options.render.threads = static_cast<int>(threads); });
    add_value(
        app, "--dump-after", "PASS",
        "Print the graph on standard error after this pass, or after each with 'all'", "a pass",
        [](const std::string& text) { return pass_named(text, true); },
        [&](const std::string& pass) { options.dump_after = pass; });
    app.add_flag("--time", options.time, "Print how long each stage takes, on standard error");
    app.add_flag("-q,--quiet", options.quiet, "Print only errors and warnings, no progress and no summary");
}

std::optional<Vec3> parse_place(const std::string& text) {
    const std::optional<Vec3> place = parse_vector(text);
    return place && is_place(*place) ? place : std::nullopt;
}

void add_camera(CLI::App& app, Options& options) {
    StageOptions& compile = options.render.compile;
    compile.view.shaped = !can_sweep(app); // a film keeps the shape of screens
    const bool in_parts = app.get_name() == "render";
    add_value(app, "--size", "WxH",
              compile.view.shaped
                  ? "Size of the picture in pixels (default: as many as 1280x720 has, in a shape "
                    "that suits the model)"
                  : "Size of the picture in pixels (default 1280x720)",
              in_parts ? "a size such as 1280x720, at most 131072 a side"
                       : "a size such as 1280x720, at most 32768 a side",
              in_parts ? parse_large_size : parse_size, [&](ImageSize size) {
                  compile.view.size = size;
                  compile.view.shaped = false;
              });
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
           "Camera: any of location=X,Y,Z look_at=X,Y,Z up=X,Y,Z angle=DEGREES orthographic width=UNITS "
           "aperture=RADIUS focus=X,Y,Z; the model sets the rest, or graftal chooses it")
        ->allow_extra_args(false)
        ->type_name("\"WORDS\"");
    const auto address = [&compile](const std::string& text) {
        std::string problem;
        compile.view.zoom.at = parse_address(text, problem);
        if (!compile.view.zoom.at) throw CLI::ValidationError(fmt::format("--at: '{}': {}", text, problem));
    };
    app.add_option_function<std::string>(
           "--at", address,
           "Look at the part with this address, from its own frame: the names of "
           "the objects on the way from the root, such as "
           "up.left.(right.up)*40; X#2 is the second instance of X")
        ->type_name("ADDRESS")
        ->take_last();
    add_swept(
        app, options, "--zoom", "F",
        "Enlarge F times, such as 1e100 or 2^330, around the part at --at, or else the point that the camera "
        "looks at",
        zoom_values, parse_zoom, parse_zoom_sweep,
        [&](Magnification zoom) { compile.view.zoom.zoom = zoom; });
    add_value(
        app, "--eye", "X,Y,Z",
        "With --zoom: the place of the eye, from the point that the zoom is about, in lengths after it; "
        "--camera says where it looks (default: as far from the point as --camera has it)",
        "a place such as 0,0.5,4", parse_place, [&](Vec3 eye) { compile.view.zoom.eye = eye; })
        ->needs("--zoom");
}

/// An error whose inverse is a number, too, or 0.
std::optional<double> parse_error(const std::string& text) {
    const std::optional<double> error = parse_at_least(text, 0);
    return error && (*error == 0 || is_size(*error)) ? error : std::nullopt;
}

void add_error(CLI::App& app, Options& options) {
    StageOptions& compile = options.render.compile;
    CLI::Option* pixels =
        add_value(app, "--error", "PX",
                  "Leave out parts smaller than this in the picture (default 0.5; 0 keeps every part)",
                  "0, or a number of pixels from 1e-100 to 1e100", parse_error, [&](double error) {
                      compile.detail.error_px = error;
                      options.error_asked = true;
                  });
    add_value(app, "--error-world", "X", "Like --error, but a length in the model's units",
              "0, or a length from 1e-100 to 1e100", parse_error,
              [&](double error) {
                  compile.detail.error_world = error;
                  options.error_asked = true;
              })
        ->excludes(pixels);
}

void add_plain_light(CLI::App& app, Options& options) {
    app.add_flag_callback(
        "--plain-light", [&options] { options.render.compile.view.light = DefaultLight::plain; },
        "Where the model names no light: one sun and no sky, which is many times faster to draw");
}

void add_work(CLI::App& app, Options& options, const std::string& help) {
    add_value(
        app, "--work", "SECONDS", help, "a number of seconds above 0",
        [](const std::string& text) { return parse_at_least(text, 1e-3); },
        [&](double seconds) { options.render.limit_work(seconds); });
}

void add_inspecting_work(CLI::App& app, Options& options) {
    add_work(
        app, options,
        fmt::format("Limit of the work, roughly in seconds of one processor; graftal refuses a model that "
                    "takes more (default {})",
                    inspecting_seconds));
}

void add_irradiance(CLI::App& app, Options& options) {
    app.add_flag("--irradiance", options.irradiance,
                 "Trace the light on each organ of the plant: of the model's sky and suns, or of a white sky "
                 "where it names no light. An open horizontal plane has 1");
    add_value(
        app, "--samples", "N",
        fmt::format(
            "With --irradiance: samples of each organ, as far as --work allows (default: {}, and more "
            "until the organs' light has a standard error of {:g}% of its mean)",
            PlantLightOptions::usual_samples, 100 * PlantLightOptions::enough_error),
        "a whole number from 4 to 65536",
        [](const std::string& text) { return parse_whole(text, 4, 65'536); },
        [&options](std::uint64_t samples) { options.render.samples = static_cast<int>(samples); })
        ->needs("--irradiance");
}

namespace {

double native_work(Quality quality) {
    return PictureWishes().work(quality);
}

/// "5, 9 or 600"
std::string by_each_quality(double (*work)(Quality)) {
    return fmt::format("{:g}, {:g} or {:g}", work(Quality::draft), work(Quality::normal),
                       work(Quality::best));
}

} // namespace

void add_view(CLI::App& app, Options& options) {
    add_camera(app, options);
    add_error(app, options);
    StageOptions& compile = options.render.compile;
    add_work(
        app, options,
        fmt::format("Limit of the work for a picture, roughly in seconds of one processor; graftal draws "
                    "coarser where a picture would take more (default by --quality: {}; with POV-Ray {})",
                    by_each_quality(native_work), by_each_quality(povray_seconds)));
    app.add_flag("--visible-only", compile.detail.visible_only,
                 "Leave out parts that the camera does not see, and their shadows too");
    add_plain_light(app, options);
    add_choice<Quality>(
        app, "--quality",
        "How finely graftal samples the picture, and how long that may take: see --work and --noise "
        "(default normal)",
        {{"draft", Quality::draft}, {"normal", Quality::normal}, {"best", Quality::best}},
        [&options](Quality quality) { options.render.compile.view.quality = quality; });
    app.add_flag("--flatten", options.render.cut.flatten,
                 "Write every part in its place, without sharing (for comparison)");
}

void add_model(CLI::App& app, Options& options) {
    const auto set = [&options](const std::string& model) { options.operands = {model}; };
    const std::string help =
        model_file_help(app.get_name() == "render" ? ", or .pifs of 'graftal fit --blocks'" : "");
    app.add_option_function<std::string>("MODEL", set,
                                         can_sweep(app) ? help : help + ", or - for standard input")
        ->required()
        ->type_name("");
}

namespace {

constexpr int most_samples_a_pixel = 65'536;

std::vector<std::string_view> engine_names() {
    std::vector<std::string_view> names = {auto_engine};
    for (const Engine& engine : engines())
        names.push_back(engine.name);
    return names;
}

/// "Renderer: native, graftal's own ray tracer; povray, POV-Ray 3.7 (default auto: native)"
std::string engines_text() {
    std::string text = "Renderer";
    for (const Engine& engine : engines())
        text +=
            fmt::format("{}{}, {}", &engine == &engines().front() ? ": " : "; ", engine.name, engine.summary);
    return text + fmt::format(" (default {}: a graphics card if there is one, else {})", auto_engine,
                              engines().front().name);
}

} // namespace

void add_bits(CLI::App& app, Options& options) {
    add_choice<SampleFormat>(app, "--bits", "Bits of each colour of a PNG (default 8)",
                             {{"8", SampleFormat::srgb8}, {"16", SampleFormat::srgb16}},
                             [&options](SampleFormat format) { options.render.format = format; });
}

void add_engine(CLI::App& app, Options& options, const std::string& help,
                const std::vector<std::string_view>& names) {
    Choices<std::string_view> choices;
    for (const std::string_view name : names)
        choices.emplace_back(name, name);
    add_choice(app, "--engine", help, choices, // which card there is, is asked only then
               [&options](std::string_view name) { options.engine = find_engine(name); });
}

void add_device(CLI::App& app, Options& options) {
    add_value(
        app, "--device", "N",
        "Graphics card of '--engine gpu', by its number in 'graftal version --json' (default: the first "
        "card)",
        "a whole number, 0 or more", [](const std::string& text) { return parse_whole(text, 0, UINT32_MAX); },
        [&options](std::uint64_t device) { options.render.devices = {device}; });
}

void add_drawing(CLI::App& app, Options& options) {
    add_engine(app, options, engines_text(), engine_names());
    add_devices(app, options);
    add_value(
        app, "--samples", "N", "Samples per pixel under soft light; overrides --quality",
        fmt::format("a whole number from 1 to {}", most_samples_a_pixel),
        [](const std::string& text) { return parse_whole(text, 1, most_samples_a_pixel); },
        [&options](std::uint64_t samples) { options.render.samples = static_cast<int>(samples); });
    add_value(
        app, "--noise", "N",
        "Under soft light, take no more samples where the error is below N of 255 levels",
        "a number from 0 to 255",
        [](const std::string& text) {
            const std::optional<double> noise = parse_at_least(text, 0);
            return noise && *noise <= 255 ? noise : std::nullopt;
        },
        [&options](double noise) { options.render.noise_255 = noise; });
    add_choice<bool>(app, "--denoise",
                     "Take noise out of soft light (default: on, except for '--quality best')",
                     {{"on", true}, {"off", false}}, [&options](bool on) { options.render.denoise = on; });
    app.add_flag("--test-listed-lights", options.render.listed_lights,
                 "Draw soft light from the list of lights that POV-Ray gets");
    app.add_flag("--unconfined", options.render.unconfined,
                 "Run POV-Ray with your permissions, your environment and no limits (for a program in its "
                 "place that runs it somewhere else)");
    const auto antialias = [&options](const std::string& text) {
        const auto depth = parse_whole(text, 1, 9);
        if (!depth && text != "off")
            throw CLI::ValidationError(
                fmt::format("--antialias: '{}' is neither 'off' nor a whole number from 1 to 9", text));
        options.render.antialias = depth ? std::optional(static_cast<int>(*depth)) : std::nullopt;
    };
    app.add_option_function<std::string>(
           "--antialias", antialias, "Smooth edges with up to 4^(N-1) samples per pixel, or off (default 2)")
        ->type_name("off|N")
        ->take_last();
}

namespace {

/// Whether an output names a folder: one that is there, or one by the slash at its end.
bool names_folder(const std::string& output) {
    std::error_code error;
    return output.ends_with('/') || std::filesystem::is_directory(output, error);
}

} // namespace

std::string refusal_of_folder(Options& options) {
    std::string& output = options.render.output;
    if (options.command->folder == FolderAsOutput::is_written || !names_folder(output)) return {};
    if (options.command->folder == FolderAsOutput::refused)
        return fmt::format(
            "'{}' is a folder: name a file in it, such as '-o {}'", output,
            (std::filesystem::path(output) / (std::string("NAME") + options.command->ending)).string());
    if (!output.ends_with('/')) output += '/';
    return {};
}

std::string refusal_of_names(const Options& options) {
    const std::string* const names[] = {&options.render.output, &options.render.keep, &options.points.card,
                                        &options.farm.folder, &options.farm.result};
    for (const std::string* const name : names)
        if (!is_printable(*name))
            return fmt::format(
                "'{}': a name that graftal writes is in UTF-8, without line ends and other control "
                "characters: choose another",
                *name);
    return {};
}

} // namespace graftal
