#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/session/stage_options.h"
#include "runtime/export/formats.h"
#include "runtime/image/image.h"
#include "runtime/image_files/animation.h"
#include "runtime/points/target_picture.h"
#include "runtime/points/tone.h"
#include "runtime/render/render.h"
#include "runtime/render/sweep.h"
#include "tools/graftal/options/farm.h"

namespace graftal {

struct Command;

/// Options of `animate` besides those of `render`.
struct AnimationOptions {
    std::size_t frames = 60;
    FrameRate rate;
    std::optional<double> turn_deg; ///< nothing: once round where nothing else moves
    std::vector<Sweep> sweeps;
    Ease ease = Ease::linear;
    double shutter = 0; ///< share of a frame's time
    bool keep_frames = false;
    std::string identity; ///< the options that change what the frames show, and the version
};

/// Options of `points` and `collage` besides.
struct PointsSettings {
    std::optional<std::uint64_t> points;
    PointColour colour = PointColour::tint;
    Tone tone;
    std::string card;   ///< file, or ""
    std::string target; ///< of `collage` and `fit`
    TargetCriterion criterion;
};

/// Options of `fit` besides.
struct FitSettings {
    std::size_t most_maps = 8;
    bool similar = false;
    bool occupancy = false; ///< equal cells, and not those within one cell
    bool in_colour = false; ///< a tint for each map, too
    std::string start;      ///< a model, or ""
    bool blocks = false;
    /// With `blocks` in levels of 255; of drawings a share of the shortest line.
    std::optional<double> tolerance;
};

/// Options of `studio`.
struct StudioOptions {
    bool browser = true;               ///< open one
    std::string address = "127.0.0.1"; ///< to serve on
    std::uint16_t port = 0;            ///< 0: any
    std::uint64_t memory_bytes = 4ull << 30;
};

/// The limit of work for a command that only tells of a model, where --work does not say.
inline constexpr double inspecting_seconds = 10;

/// The command line, understood.
struct Options {
    const Command* command = nullptr;  ///< never null after parse_command_line()
    std::vector<std::string> operands; ///< the model or models; for compare the two pictures
    RenderOptions render;           ///< `compile` and `output` are of every command: "-" is standard output
    bool output_is_default = false; ///< nobody has named the output: the model's name gave it
    std::string dump_after;         ///< a pass, "all", or ""
    bool time = false;
    bool quiet = false;

    const Engine* engine = nullptr;  ///< --engine; never null after parse_command_line()
    bool draws = false;              ///< the command has --engine
    std::optional<bool> progressive; ///< of `render`: as asked for; run_render() decides
    bool watch = false;              ///< of `render`: again after each change
    std::string identifier;          ///< of `compile` to an .inc; "": as the model's file
    AnimationOptions animation;
    PointsSettings points;
    FitSettings fit;
    FarmOptions farm;
    StudioOptions studio;
    bool error_asked = false; ///< --error or --error-world is given
    ExportOptions file;       ///< of `export`; its output and metadata are those of `render`
    bool json = false;
    bool check = false;                ///< of `format`: write nothing
    bool boxes = false;                ///< of `stats`
    bool plant = false;                ///< of `stats`: measures of the plant, in place of the model's
    std::optional<double> ground_area; ///< with `plant`
    bool irradiance = false; ///< of `stats` with `plant`, and of `export` for plants: the light on organs
    bool as_rifs = false;    ///< of `print`
    double threshold = 0;
    bool in_parts = false; ///< the picture of `render` may be larger than one that is drawn at once
};

struct ParsedCommandLine {
    std::optional<Options> options; ///< nothing: end with exit_status (--help, --version, a wrong option)
    int exit_status = 0;
};

/// Reads the command line; help goes to standard output, complaints in the GNU form to standard error.
ParsedCommandLine parse_command_line(int argc, const char* const* argv);
/// Reads words in place of argv. `in_parts` is that of Options.
ParsedCommandLine parse_command_line(std::vector<std::string> words, bool in_parts = false);

} // namespace graftal
