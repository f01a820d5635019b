#include <fmt/format.h>

#include "runtime/studio/asks.h"

namespace graftal {

namespace {

/// A word as a POSIX shell reads it.
std::string quoted(const std::string& word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,^@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word)
        text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

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

} // namespace

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
    if (command != "render") return words;
    if (view.quality != Quality::normal)
        add("--quality", by_quality<const char*>(view.quality, "draft", "normal", "best"));
    add("--engine", state.engine);
    return words;
}

std::string command_line(const StudioState& state) {
    std::string text;
    for (const std::string& word : command_words(state, "render"))
        text += (text.empty() ? "" : " ") + quoted(word);
    return text;
}

} // namespace graftal
