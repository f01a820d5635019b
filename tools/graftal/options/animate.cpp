#include "tools/graftal/options/animate.h"

#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "compiler/import/importers.h"
#include "compiler/support/shell_words.h"
#include "runtime/render/animate.h"

namespace graftal {

std::string complete_animation(Options& options) {
    AnimationOptions& animation = options.animation;
    if (options.operands.front() == "-")
        return "an animation reads its model more than once: give the model as a file, not on standard input";
    if (options.render.output.empty()) options.render.output = model_stem(options.operands.front()) + ".gif";
    const std::optional<AnimationKind> kind = animation_kind(options.render.output);
    if (!kind)
        return fmt::format(
            "'{}': the name of an animation must end in .gif, .png, .apng, .mp4, .webm or .usda; the "
            "name of a directory "
            "of frames has no extension, or ends in a slash",
            options.render.output);
    if (kind == AnimationKind::usd) {
        if (options.in_parts) return "a .usda is written at once: 'graftal animate' does it";
        if (animation.turn_deg) return "--turn: whoever reads a .usda turns the camera: leave it out";
        if (animation.sweeps.empty())
            return "a .usda shows a model that changes: give --steps, --seed or --set a value such as 1..8";
    }
    if (kind == AnimationKind::gif && animation.rate.hundredths > fastest_gif.hundredths)
        return fmt::format("--fps: a GIF shows at most {:g} frames per second", fastest_gif.per_second());
    const ImageSize size = options.render.compile.view.size;
    if (kind == AnimationKind::video && (size.width % 2 != 0 || size.height % 2 != 0))
        return fmt::format("--size: a video needs an even width and height, such as {}x{}",
                           size.width + size.width % 2, size.height + size.height % 2);
    if (!animation.turn_deg) animation.turn_deg = animation.sweeps.empty() ? 360 : 0;
    return {};
}

AnimateOptions animate_options(const Options& options) {
    AnimateOptions animate;
    animate.render = options.render;
    animate.engine = options.engine;
    animate.output = options.render.output;
    animate.frames = options.animation.frames;
    animate.rate = options.animation.rate;
    animate.turn_deg = *options.animation.turn_deg;
    animate.sweeps = options.animation.sweeps;
    animate.ease = options.animation.ease;
    animate.shutter = options.animation.shutter;
    animate.keep_frames = options.animation.keep_frames;
    animate.identity = options.animation.identity;
    return animate;
}

std::string frame_identity(const CLI::App& command, const Engine& engine) {
    static const std::set<std::string> harmless = {"MODEL",    "--output", "--fps",        "--keep-frames",
                                                   "--time",   "--quiet",  "--dump-after", "--threads",
                                                   "--engine", "--root",   "--unconfined"};
    std::string text = "graftal " GRAFTAL_VERSION;
    if (&engine != &engines().front()) // which may be named or not
        text += fmt::format("\n--engine {}", engine.name);
    for (const CLI::Option* option : command.get_options())
        if (option->count() > 0 && !harmless.contains(option->get_name()))
            text += "\n" + option->get_name() + " " + shell_quoted(option->results());
    return text;
}

} // namespace graftal
