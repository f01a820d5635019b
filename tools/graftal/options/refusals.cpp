#include "tools/graftal/options/refusals.h"

#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "runtime/image_files/image_files.h"
#include "runtime/render/native_engine.h"

namespace graftal {

namespace {

/// The first option on the command line that is not among those that are of use, or "".
std::string useless_option(const CLI::App& command, std::span<const std::string_view> useful) {
    for (const CLI::Option* const option : command.get_options())
        if (option->count() > 0 && std::ranges::find(useful, option->get_name()) == useful.end())
            return option->get_name();
    return {};
}

} // namespace

std::string refusal_to_watch(const Options& options) {
    if (options.engine && options.engine->name != native_engine.name)
        return fmt::format("--watch draws with '--engine native': leave out '--engine {}'",
                           options.engine->name);
    if (options.operands.front() == "-")
        return "--watch: standard input does not change: give the name of a model's file";
    if (options.render.output == "-")
        return "--watch draws one picture after the other: name their file with '-o FILE'";
    return {};
}

std::string refusal_of_size(const Options& options) {
    const ImageSize size = options.render.compile.view.size;
    if (!options.render.tile) {
        if (options.in_parts || is_drawn_at_once(size)) return {};
        return fmt::format("--size: a picture of {}x{} is too large to be drawn at once (at most 32768 a "
                           "side, and 2^28 pixels): draw it in tiles with 'graftal farm plan', or a part of "
                           "it with --tile",
                           size.width, size.height);
    }
    if (!options.render.tile->lies_in(size))
        return fmt::format("--tile: this part is not within the {}x{} pixels of the picture", size.width,
                           size.height);
    if (options.progressive == true || options.watch)
        return fmt::format("--tile draws once, at its finest: leave out {}",
                           options.watch ? "--watch" : "--progressive");
    return {};
}

std::string refusal_of_pifs(const CLI::App& command, const Options& options) {
    constexpr std::string_view of_pifs[] = {"MODEL",  "--output", "--size",    "--bits",
                                            "--work", "--memory", "--threads", "--quiet"};
    if (options.in_parts) return "a .pifs file is decoded at once: 'graftal render' does it";
    if (const std::string useless = useless_option(command, of_pifs); !useless.empty())
        return fmt::format(
            "{}: a .pifs file holds the blocks of a picture, and has no use for it: leave it out", useless);
    return is_exr_name(options.render.output) ? "a .pifs file is decoded to a PNG: name it so" : "";
}

std::string refusal_of_usd(const CLI::App& command) {
    constexpr std::string_view of_usd[] = {
        "MODEL",         "--output", "--frames", "--fps",         "--ease", "--steps",   "--seed",
        "--set",         "--preset", "--exact",  "--error",       "--size", "--camera",  "--memory",
        "--plain-light", "--root",   "--quiet",  "--error-world", "--time", "--threads", "--dump-after"};
    const std::string useless = useless_option(command, of_usd);
    return useless.empty() ? ""
                           : fmt::format("{}: a .usda holds the model, not pictures: leave it out", useless);
}

std::string refusal_of_engine(const Options& options) {
    return options.engine->refusal(options.render);
}

} // namespace graftal
