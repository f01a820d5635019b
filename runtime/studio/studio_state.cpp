#include "runtime/studio/studio_state.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number_range.h"
#include "compiler/support/path_text.h"
#include "compiler/zoom/address.h"
#include "compiler/zoom/magnification.h"
#include "runtime/studio/binary_message.h"
#include "runtime/studio/film_framing.h"
#include "runtime/studio/message_reader.h"

namespace graftal {

namespace {

void read_size(const MessageReader& message, ImageSize& size) {
    size.width = static_cast<int>(message.whole("width", most_page_side).value_or(960));
    size.height = static_cast<int>(message.whole("height", most_page_side).value_or(540));
    if (size.width < 1 || size.height < 1 || std::int64_t{size.width} * size.height > most_page_pixels)
        throw BadMessage(fmt::format("a picture of {}x{} pixels: a page's has 1 to {}", size.width,
                                     size.height, most_page_pixels));
}

std::optional<Vec3> place(const MessageReader& camera, const char* field) {
    const std::optional<Vec3> vector = camera.vector(field);
    if (vector && !is_place(*vector)) throw BadMessage(fmt::format("'{}': {}", field, range_hint));
    return vector;
}

std::optional<double> size(const MessageReader& camera, const char* field, bool may_be_nothing) {
    const std::optional<double> value = camera.number(field);
    if (value && !((may_be_nothing && *value == 0) || (*value > 0 && is_size(*value))))
        throw BadMessage(fmt::format("'{}': {}", field, range_hint));
    return value;
}

} // namespace

CameraOverride read_camera(const nlohmann::json& object) {
    const MessageReader camera(object);
    CameraOverride asked{.location = place(camera, "location"),
                         .look_at = place(camera, "look_at"),
                         .up = camera.vector("up"),
                         .angle_deg = camera.number("angle_deg"),
                         .orthographic = camera.flag("orthographic").value_or(false),
                         .width = size(camera, "width", false),
                         .aperture = size(camera, "aperture", true),
                         .focus = place(camera, "focus")};
    // A page says the width of a picture by parallel rays, and the angle of others.
    if (asked.width && !asked.angle_deg) asked.orthographic = true;
    if (asked.up && *asked.up != Vec3(0.0) && !is_direction(*asked.up))
        throw BadMessage(fmt::format("'up': {}", range_hint));
    if (asked.angle_deg && !(*asked.angle_deg >= least_size && *asked.angle_deg < 180))
        throw BadMessage("'angle_deg' does not lie between 0 and 180");
    return asked;
}

ZoomRequest read_zoom(const std::string& at, const std::string& factor) {
    ZoomRequest zoom;
    if (!at.empty()) {
        std::string problem;
        zoom.at = parse_address(at, problem);
        if (!zoom.at) throw BadMessage(fmt::format("'at': {}", problem));
    }
    if (!factor.empty()) {
        zoom.zoom = Magnification::parse(factor);
        if (!zoom.zoom || !(zoom.zoom->log2() >= std::log2(least_size)))
            throw BadMessage("'zoom' is not a factor such as \"1e30\" or \"2^330\"");
    }
    return zoom;
}

namespace {

/// Reads `steps`, as `--steps` means it: between whole steps there is a time.
void read_steps(const MessageReader& message, LowerOptions& lower) {
    if (const std::optional<double> steps = message.number("steps")) {
        if (!(*steps >= 0 && *steps <= static_cast<double>(most_steps)))
            throw BadMessage(fmt::format("'steps' is not a number from 0 to {}", most_steps));
        if (*steps == std::floor(*steps))
            lower.steps = static_cast<unsigned>(*steps);
        else
            lower.time = *steps;
    }
    if (const std::optional<double> time = message.number("time")) {
        if (!(*time >= 0 && *time <= static_cast<double>(most_steps)))
            throw BadMessage(fmt::format("'time' is not a number from 0 to {}", most_steps));
        lower.time = *time;
    }
}

std::map<std::string, std::string> read_files(const nlohmann::json& files) {
    const MessageReader texts(files);
    std::map<std::string, std::string> read;
    for (const auto& file : files.items())
        read[normalised_path(file.key())] = texts.needed_text(file.key().c_str());
    return read;
}

Quality quality_named(const std::string& name) {
    static constexpr std::pair<const char*, Quality> qualities[] = {
        {"draft", Quality::draft}, {"normal", Quality::normal}, {"best", Quality::best}};
    for (const auto& [known, quality] : qualities)
        if (name == known) return quality;
    throw BadMessage("'quality' is none of draft, normal, best");
}

} // namespace

StudioState read_state(const nlohmann::json& object, bool has_number) {
    const MessageReader message(object);
    StudioState state;
    if (has_number)
        state.number = static_cast<std::uint32_t>(message.needed_whole("number", first_ask_id - 1));
    state.name = message.text("name").value_or("");
    state.text = message.text("text");
    if (const nlohmann::json* const files = message.object("files")) state.files = read_files(*files);
    LowerOptions& lower = state.stages.lower;
    if (const nlohmann::json* const set = message.object("set")) {
        const MessageReader values(*set);
        for (const auto& [name, value] : set->items())
            if (const std::optional<double> number = values.number(name.c_str())) lower.set[name] = *number;
    }
    read_steps(message, lower);
    lower.seed = message.whole("seed", UINT64_MAX);
    read_size(message, state.stages.view.size);
    ViewOptions& view = state.stages.view;
    if (const nlohmann::json* const camera = message.object("camera")) {
        state.camera = *camera;
        view.camera = read_camera(*camera);
    }
    if (const nlohmann::json* const film = message.object("film")) {
        check_film(*film);
        state.film = *film;
    }
    state.at = message.text("at").value_or("");
    state.zoom = message.text("zoom").value_or("");
    view.zoom = read_zoom(state.at, state.zoom);
    if (view.zoom.zoom) view.zoom.eye = view.camera.location;
    state.engine = message.text("engine").value_or("native");
    state.stages.view.quality = quality_named(message.text("quality").value_or("normal"));
    state.threads = static_cast<int>(message.whole("threads", 512).value_or(0));
    return state;
}

} // namespace graftal
