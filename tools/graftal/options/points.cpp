#include "tools/graftal/options/points.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "compiler/import/importers.h"
#include "compiler/primitives/mesh_file.h"
#include "compiler/support/number.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/points/card.h"
#include "runtime/points/draw_points.h"
#include "runtime/render/gpu_engine.h"
#include "runtime/render/native_engine.h"
#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/values.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

constexpr double most_points = 1e15;

/// "20000000", "2e7": a whole number, also by a power of ten.
std::optional<std::uint64_t> parse_points(const std::string& text) {
    const std::optional<double> value = parse_number(text);
    if (!value || !(*value >= 1 && *value <= most_points) || *value != std::floor(*value))
        return std::nullopt;
    return static_cast<std::uint64_t>(*value);
}

/// An option whose value is a number above 0.
void add_positive(CLI::App& app, const std::string& name, const std::string& help, double& value) {
    const auto set = [name, &value](const std::string& text) {
        const std::optional<double> number = parse_number(text);
        if (!number || !(*number > 0 && *number <= 1e12))
            throw CLI::ValidationError(fmt::format("{}: '{}' is not a number above 0", name, text));
        value = *number;
    };
    app.add_option_function<std::string>(name, set, help)->type_name("X")->take_last();
}

/// Adds the options that make colours and light of the measure.
void add_measure(CLI::App& app, Tone& tone) {
    add_value(
        app, "--palette", "NAME|COLOURS",
        fmt::format("Colour by density, with this palette ({}) or with colours such as '#102040,#ffe080'",
                    ColourScale::names()),
        fmt::format("a palette ({}) or colours such as #102040,#ffe080", ColourScale::names()),
        [](const std::string& text) { return ColourScale::parse(text); },
        [&tone](ColourScale&& scale) { tone.scale = std::move(scale); });
    add_value(app, "--ground", "COLOUR",
              "Colour behind the points, such as black or #102040, in place of the background",
              "black, white or a colour such as #102040", parse_colour,
              [&tone](Rgb rgb) { tone.ground = rgb; });
    app.add_flag("--light", tone.light, "The points shine, on black unless --ground names another colour");
    add_value(app, "--glow", "SHARE", "Like --light, and this share of the light spreads around the points",
              "a number from 0 to 1", parse_share, [&tone](double share) {
                  tone.glow = share;
                  tone.light = true;
              });
}

/// Fills in what `--card` leaves out; returns what is wrong with it, or "".
std::string complete_card(Options& options) {
    const std::filesystem::path card = options.points.card;
    if (same_place(options.points.card, options.operands.front()))
        return fmt::format("--card: '{}' is the model: name another file", card.string());
    if (card.extension() != ".inst") return fmt::format("--card: '{}' does not end in .inst", card.string());
    options.output_is_default = options.render.output.empty();
    if (options.output_is_default)
        options.render.output = std::filesystem::path(card).replace_extension(".png").string();
    const std::filesystem::path picture = options.render.output;
    if (picture.extension() != ".png") return "--card: the name of its picture must end in .png";
    if (picture.parent_path() != card.parent_path()) return "--card: its picture must lie in the same folder";
    if (!is_card_picture(picture.filename().string()))
        return "--card: the name of its picture must not contain quotes, backslashes or control characters";
    return {};
}

} // namespace

void add_points_options(CLI::App& app, Options& options) {
    PointsSettings& settings = options.points;
    app.add_option("-o,--output", options.render.output,
                   "Picture to write, .png or .exr, or a point cloud, .ply (default: MODEL's name + .png, in "
                   "this folder)")
        ->type_name("FILE");
    const auto points = [&settings](const std::string& text) {
        settings.points = parse_points(text);
        if (!settings.points)
            throw CLI::ValidationError(
                fmt::format("--points: '{}' is not a whole number from 1 to 1e15, such as 1e9", text));
    };
    app.add_option_function<std::string>("--points", points,
                                         "Number of points (default: 100 per pixel; for a cloud 1e6)")
        ->type_name("N")
        ->take_last();
    add_engine(app, options,
               "What makes the points: native, the processors; gpu, the graphics card (default auto: a card "
               "if there is one)",
               {auto_engine, native_engine.name, gpu_engine.name});
    add_device(app, options);
    add_choice<PointColour>(
        app, "--color",
        "Colour by the model's tints, by the last map, or by the density of the points (default tint)",
        {{"tint", PointColour::tint}, {"map", PointColour::map}, {"density", PointColour::density}},
        [&settings](PointColour colour) { settings.colour = colour; });
    add_positive(app, "--exposure", "How clearly a few points show beside many (default 30)",
                 settings.tone.exposure);
    add_positive(app, "--gamma", "Above 1 lightens the thin parts, below 1 darkens them (default 1)",
                 settings.tone.gamma);
    add_measure(app, settings.tone);
    add_bits(app, options);
    app.add_flag("--transparent", settings.tone.transparent, "Write an alpha channel instead of a background")
        ->excludes("--ground")
        ->excludes("--light")
        ->excludes("--glow");
    app.add_option("--card", settings.card,
                   "Also write a model of a flat cube that bears the picture, in place of a flat model, for "
                   "use as a\n"
                   "terminal (default size 512x512, exposure 800; the picture is transparent)")
        ->type_name("FILE.inst");
    app.parse_complete_callback([&app, &options, &settings] {
        if (settings.tone.light && !settings.tone.ground) settings.tone.ground = Rgb(0.0);
        if (app.count("--palette") > 0 && app.count("--color") == 0) settings.colour = PointColour::density;
        if (settings.card.empty()) return;
        settings.tone.transparent = true;
        if (app.count("--size") == 0) options.render.compile.view.size = {512, 512};
        if (app.count("--exposure") == 0) settings.tone.exposure = 800;
    });
    app.footer("Examples:\n"
               "  graftal points scenes/ifs/fern.rifs                   # makes fern.png\n"
               "  graftal points scenes/ifs/fern.rifs --points 1e9 --size 2000x3000 -o fern.exr\n"
               "  graftal points scenes/hart/pound_sign.rifs --points 1e7 -o pound_sign.ply\n"
               "  graftal points scenes/ifs/twin_dragon.rifs --color map\n"
               "  graftal points scenes/plants/maple_leaf.rifs --card leaf_card.inst   # and leaf_card.png\n"
               "  graftal points scenes/orbits/gumowski_mira.rifs --color density --set a=0.31\n"
               "  graftal points scenes/orbits/clifford.rifs --palette gold --glow 0.3 --bits 16");
}

std::string complete_points(Options& options) {
    if (!options.points.card.empty())
        if (std::string wrong = complete_card(options); !wrong.empty()) return wrong;
    if (options.render.output.empty() && options.operands.front() == "-")
        return "a model from standard input has no name: name the picture with '-o FILE'";
    if (options.render.output.empty()) {
        options.output_is_default = true;
        options.render.output = model_stem(options.operands.front()) + ".png";
    }
    if (!options.points.card.empty() && options.points.tone.light)
        return "--card: a card is no light: leave --light and --glow out";
    if (!options.points.card.empty() && options.points.tone.ground)
        return "--card: a card is clear beside its points: leave --ground out";
    if (is_cloud_name(options.render.output))
        return options.points.colour == PointColour::density
                   ? "--color density: a cloud has no pixels to count points in; write a picture, or choose "
                     "tint or map"
                   : "";
    if (!is_picture_name(options.render.output))
        return fmt::format("'{}': the name must end in .png, .exr or .ply", options.render.output);
    return {};
}

namespace {

constexpr const char* target_help =
    "Picture of the target set: its dark pixels, or its opaque pixels if it has an alpha channel";

/// The picture of a target, and which of its pixels are meant.
void add_target(CLI::App& app, Options& options, const std::string& help) {
    app.add_option("TARGET", options.points.target, help)->required()->type_name("");
    add_value(app, "--threshold", "T",
              "Pixels darker than this, or at least this opaque, belong to the target (default 0.5)",
              "a number from 0 to 1", parse_share,
              [&options](double threshold) { options.points.criterion.threshold = threshold; });
    app.add_flag("--light", options.points.criterion.light, "The lighter pixels belong to the target");
}

} // namespace

void add_collage_options(CLI::App& app, Options& options) {
    add_target(app, options, target_help);
    const auto set = [&options](const std::string& model) { options.operands = {model}; };
    app.add_option_function<std::string>("MODEL", set, "Model file of a flat iterated function system, or -")
        ->required()
        ->type_name("");
    app.add_flag("--json", options.json, "Print one JSON object on standard output");
    app.footer(
        "graftal lays the picture over the view that 'points' and 'render' have of the model at its size.\n"
        "Example:\n"
        "  graftal points leaf.rifs --size 400x400 --transparent -o leaf.png\n"
        "  graftal collage leaf.png leaf.rifs");
}

void add_fit_options(CLI::App& app, Options& options) {
    FitSettings& fit = options.fit;
    add_target(
        app, options,
        std::string(target_help) +
            "; or a cloud of points or a mesh (.ply, .obj, .stl), for maps of space; or a drawing (.svg, "
            ".csv, .txt, .lsys), for an L-system");
    app.add_option(
           "-o,--output", options.render.output,
           "Model to write: .rifs, .lsys for a drawing, or .pifs with --blocks (default: TARGET's name, in "
           "this folder)")
        ->type_name("FILE");
    add_value(
        app, "--maps", "N", "Most maps of the system (default 8)", "a whole number from 2 to 24",
        [](const std::string& text) { return parse_whole(text, 2, 24); },
        [&fit](std::uint64_t maps) { fit.most_maps = static_cast<std::size_t>(maps); });
    app.add_flag("--similar", fit.similar,
                 "Only maps that keep angles: turns, mirrors and one factor of size");
    add_choice<bool>(
        app, "--objective",
        "What the search betters: near, cells of the target within one cell; occupancy, the very cells, with "
        "as many maps as --maps allows (default near)",
        {{"near", false}, {"occupancy", true}}, [&fit](bool occupancy) { fit.occupancy = occupancy; });
    app.add_flag("--color", fit.in_colour,
                 "Give each map a tint, so that the model has the target's colours");
    app.add_option(
           "--start", fit.start,
           "Model to begin with: an iterated function system in the frame in which graftal writes them, flat "
           "for a picture")
        ->type_name("MODEL");
    CLI::Option* const blocks = app.add_flag(
        "--blocks", fit.blocks,
        "Code the whole picture, grey or in colour, by blocks that are copies of larger ones: a .pifs "
        "file, which 'graftal render' decodes at any size");
    for (const char* const other :
         {"--threshold", "--light", "--maps", "--similar", "--objective", "--color", "--start"})
        blocks->excludes(other);
    add_value(app, "--tolerance", "X",
              "With --blocks: error that photographs then have, about, root mean square in levels of 255; "
              "less makes "
              "larger files (default 8). Of a drawing: ends of lines meet where they are no farther apart, "
              "as a share of "
              "the shortest line (default 0.01)",
              "a number", parse_number, [&fit](double tolerance) { fit.tolerance = tolerance; });
    add_work(app, options,
             "Limit of the search, roughly in seconds of one processor, by counted work (default 30)");
    app.add_flag("--json", options.json, "Print one JSON object on standard output");
    add_common(app, options);
    app.footer(
        "Ctrl-C ends the search, and keeps the best system so far. In the model, the picture is 1 wide, and\n"
        "its lower left corner is <0, 0>. A model of a cloud or a mesh has the target's own coordinates.\n"
        "Examples:\n"
        "  graftal fit leaf.png                                   # makes leaf.rifs\n"
        "  graftal fit leaf.png --maps 4 --work 120 --seed 7 -o other.rifs\n"
        "  graftal fit digit.png --maps 10 --objective occupancy  # the same cells, by more maps\n"
        "  graftal fit leaf.png --start leaf.rifs                 # goes on from there\n"
        "  graftal fit cloud.ply --similar                        # maps of space: makes cloud.rifs\n"
        "  graftal fit curve.svg                                  # an L-system: makes curve.lsys\n"
        "  graftal points leaf.rifs --size 400x400 -o again.png   # the target's size gives its frame\n"
        "  graftal fit --blocks photo.png --tolerance 5           # makes photo.pifs\n"
        "  graftal render photo.pifs --size 2048x2048");
}

std::string complete_fit(Options& options) {
    std::string& output = options.render.output;
    const FitSettings& fit = options.fit;
    const bool draws = is_drawing_name(options.points.target) && !fit.blocks;
    const bool solid = is_mesh_name(options.points.target) && !fit.blocks;
    const std::string ending = fit.blocks ? ".pifs" : draws ? ".lsys" : ".rifs";
    if (output.empty()) output = model_stem(options.points.target) + ending;
    if (output != "-" && !output.ends_with(ending))
        return fmt::format("'{}': the name of the model must end in {}", output, ending);
    if (draws && same_place(output, options.points.target))
        return fmt::format("'{}' is the drawing: name another file by -o", output);
    if (fit.tolerance) {
        if (!draws && !fit.blocks)
            return "--tolerance is for drawings (.svg, .csv, .txt and .lsys), and for --blocks";
        const double least = draws ? 1e-6 : 0, most = draws ? 0.2 : 255;
        if (!(*fit.tolerance >= least && *fit.tolerance <= most))
            return fmt::format("--tolerance: '{}' is not a number from {} to {}", shortest(*fit.tolerance),
                               shortest(least), shortest(most));
    }
    const TargetCriterion usual, &criterion = options.points.criterion;
    const std::string_view others = solid ? "clouds and meshes" : "drawings";
    if ((draws || solid) && (criterion.light != usual.light || criterion.threshold != usual.threshold))
        return fmt::format("--threshold and --light are for pictures, and not for {}", others);
    if (solid && (fit.occupancy || fit.in_colour))
        return fmt::format("--objective and --color are for pictures, and not for {}", others);
    if (draws && (fit.similar || fit.occupancy || fit.in_colour || !fit.start.empty() ||
                  fit.most_maps != FitSettings().most_maps))
        return "--maps, --similar, --objective, --color and --start are for pictures, and not for drawings";
    if (output == "-" && options.json)
        return "--json prints where '-o -' writes the model: leave one of them out";
    return {};
}

} // namespace graftal
