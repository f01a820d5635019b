#include <fmt/format.h>

#include "compiler/support/shell_words.h"
#include "runtime/studio/asks.h"
#include "runtime/studio/message_reader.h"

namespace graftal {

namespace {

void add_vector(std::string& text, const char* name, const std::optional<Vec3>& vector) {
    if (vector) text += fmt::format(" {}={},{},{}", name, vector->x, vector->y, vector->z);
}

void add_number(std::string& text, const char* name, const std::optional<double>& number) {
    if (number) text += fmt::format(" {}={}", name, *number);
}

std::string camera_words(const CameraOverride& camera) {
    std::string text;
    add_vector(text, "location", camera.location);
    add_vector(text, "look_at", camera.look_at);
    add_vector(text, "up", camera.up);
    add_vector(text, "focus", camera.focus);
    add_number(text, "angle", camera.angle_deg);
    if (camera.orthographic) text += " orthographic";
    add_number(text, "width", camera.width);
    add_number(text, "aperture", camera.aperture);
    return text.empty() ? text : text.substr(1);
}

/// Keys, each a share of the time and a value, as `--set` has them: "2..5@0.3..1".
std::string keys_text(const std::string& name, const nlohmann::json& keys) {
    if (!keys.is_array() || keys.size() < 2)
        throw BadMessage(fmt::format("'{}' has fewer than two key frames", name));
    std::string text;
    for (const nlohmann::json& key : keys) {
        if (!key.is_array() || key.size() != 2) throw BadMessage("a key frame is a time and a value");
        const double t = film_number(key[0]), value = film_number(key[1]);
        text += fmt::format("{}{}", text.empty() ? "" : "..", value);
        const bool is_end = &key == &keys.front() || &key == &keys.back();
        if (is_end && t != (&key == &keys.front() ? 0 : 1))
            throw BadMessage(fmt::format("the key frames of '{}' do not span the whole film", name));
        if (!is_end) text += fmt::format("@{}", t);
    }
    return text;
}

} // namespace

double film_number(const nlohmann::json& value) {
    if (!value.is_number()) throw BadMessage("a film runs over numbers");
    return value.get<double>();
}

std::vector<std::string> command_words(const StudioState& state, const std::string& command) {
    std::vector<std::string> words{"graftal", command, state.name};
    const auto add = [&](const char* option, std::string value) {
        words.emplace_back(option);
        words.push_back(std::move(value));
    };
    const LowerOptions& lower = state.stages.lower;
    const ViewOptions& view = state.stages.view;
    add("--size", fmt::format("{}x{}", view.size.width, view.size.height));
    for (const auto& [name, value] : lower.set)
        add("--set", fmt::format("{}={}", name, value));
    if (lower.time)
        add("--steps", fmt::format("{}", *lower.time));
    else if (lower.steps)
        add("--steps", fmt::format("{}", *lower.steps));
    if (lower.seed) add("--seed", fmt::format("{}", *lower.seed));
    if (const std::string camera = camera_words(view.camera); !camera.empty()) add("--camera", camera);
    if (!state.at.empty()) add("--at", state.at);
    if (!state.zoom.empty()) add("--zoom", state.zoom);
    if (view.zoom.eye)
        add("--eye", fmt::format("{},{},{}", view.zoom.eye->x, view.zoom.eye->y, view.zoom.eye->z));
    if (command == "export") return words;
    if (view.quality != Quality::normal)
        add("--quality", by_quality<const char*>(view.quality, "draft", "normal", "best"));
    if (!state.engine.empty()) add("--engine", state.engine);
    return words;
}

std::vector<std::string> film_words(StudioState state, const nlohmann::json& film) {
    constexpr std::uint64_t most_frames = 100'000;
    constexpr double fastest = 240;
    const MessageReader fields(film);
    const std::uint64_t frames = std::max<std::uint64_t>(1, fields.needed_whole("frames", most_frames));
    const double rate = fields.number("fps").value_or(25);
    if (!(rate > 0 && rate <= fastest)) throw BadMessage("'fps' is out of range");
    std::vector<std::string> moving;
    if (const nlohmann::json* const set = fields.object("set"))
        for (const auto& [name, keys] : set->items()) {
            state.stages.lower.set.erase(name);
            moving.insert(moving.end(), {"--set", name + "=" + keys_text(name, keys)});
        }
    if (const auto steps = film.find("steps"); steps != film.end() && !steps->is_null()) {
        if (!steps->is_array() || steps->size() != 2) throw BadMessage("'steps' is no list of two numbers");
        state.stages.lower.steps.reset();
        state.stages.lower.time.reset();
        moving.insert(moving.end(),
                      {"--steps", fmt::format("{}..{}", film_number((*steps)[0]), film_number((*steps)[1]))});
    }
    std::vector<std::string> words = command_words(state, "animate");
    words.insert(words.end(), moving.begin(), moving.end());
    words.insert(words.end(), {"--frames", fmt::format("{}", frames), "--fps", fmt::format("{}", rate)});
    return words;
}

std::string command_line(const std::vector<std::string>& words) {
    return shell_quoted(words);
}

} // namespace graftal
