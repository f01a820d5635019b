#include "runtime/studio/files/file_asks.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "runtime/studio/asks.h"
#include "runtime/studio/message_reader.h"

namespace graftal {

namespace {

/// Options of `render` and of `export` that a page may give, with a value or without.
constexpr std::string_view picture_options[] = {"antialias", "samples", "noise", "work", "bits"};
constexpr std::string_view export_options[] = {"limit", "unit",  "levels",     "nodes",
                                               "part",  "error", "error-world"};
constexpr std::string_view export_flags[] = {"instancing", "plotter"};

bool holds(std::span<const std::string_view> names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

std::string value_text(const std::string& name, const nlohmann::json& value) {
    if (value.is_number()) return fmt::format("{}", value.get<double>());
    if (!value.is_string()) throw BadMessage(fmt::format("'{}' is neither a number nor a text", name));
    return value.get<std::string>();
}

void add_options(const nlohmann::json& options, bool is_picture, std::vector<std::string>& words) {
    for (const auto& [name, value] : options.items()) {
        if (value.is_null()) continue;
        if (!is_picture && holds(export_flags, name)) {
            if (value == true) words.push_back("--" + name);
            continue;
        }
        if (!(is_picture ? holds(picture_options, name) : holds(export_options, name)))
            throw BadMessage(fmt::format("there is no option '{}' of this file", name));
        words.push_back(fmt::format("--{}={}", name, value_text(name, value)));
    }
}

/// The ending with its point, in lower case; "" without one.
std::string ending_of(const std::string& path) {
    const std::size_t point = path.find_last_of("./");
    if (point == std::string::npos || path[point] == '/') return {};
    std::string ending = path.substr(point);
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending;
}

} // namespace

FileJob file_job(const StudioState& state, const nlohmann::json& ask) {
    const MessageReader fields(ask);
    FileJob job{{}, {state.name, *state.text}, fields.text("path").value_or(""), {}, state.files};
    job.suffix = job.path.empty() ? fields.needed_text("suffix") : ending_of(job.path);
    if (!job.suffix.starts_with('.')) job.suffix = "." + job.suffix;
    const nlohmann::json* const film = fields.object("film");
    const bool is_folder = film && job.path.ends_with('/');
    const bool is_letters =
        std::ranges::all_of(job.suffix.substr(1), [](unsigned char c) { return std::isalnum(c); });
    constexpr std::size_t longest = 8;
    if (!is_folder && (job.suffix.size() < 2 || job.suffix.size() > longest || !is_letters))
        throw BadMessage("the file's name needs an ending, such as .png");
    StudioState shown = state;
    ImageSize& size = shown.stages.view.size;
    constexpr std::uint64_t most_side = 32768;
    size.width = static_cast<int>(std::max<std::uint64_t>(
        1, fields.whole("width", most_side).value_or(static_cast<std::uint64_t>(size.width))));
    size.height = static_cast<int>(std::max<std::uint64_t>(
        1, fields.whole("height", most_side).value_or(static_cast<std::uint64_t>(size.height))));
    const bool is_picture = job.suffix == ".png" || job.suffix == ".exr";
    if (film) {
        if (job.suffix == ".usda") { // the model itself: nobody draws it
            shown.engine.clear();
            shown.stages.view.quality = Quality::normal;
        }
        job.words = film_words(std::move(shown), *film);
        return job;
    }
    job.words = command_words(shown, is_picture ? "render" : "export");
    if (const nlohmann::json* const options = fields.object("options"))
        add_options(*options, is_picture, job.words);
    return job;
}

} // namespace graftal
