#include "runtime/studio/model_message.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/editing/positions.h"
#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "compiler/support/number_range.h"
#include "compiler/support/path_text.h"
#include "runtime/studio/text_asks.h"

namespace graftal {

namespace {

void add_place(nlohmann::json& to, const Span& span, const SourceMap& sources) {
    if (!span.known()) return;
    const TextPositions positions(sources.text(span.file));
    to["from"] = positions.utf16_of(span.begin);
    to["to"] = positions.utf16_of(span.end);
}

/// A place in a file that was read: people see no translation.
Span written(const Span& span, const SourceMap& sources) {
    if (!span.known() || !sources.original(span.file)) return span;
    return sources.origin(span);
}

/// The model's own file: the one that was read first, and that the page shows.
constexpr FileId own_file = 0;

/// The place in the model's own text that names another file; unknown where it only names one that does.
Span naming(FileId file, const SourceMap& sources) {
    const std::string_view text = sources.text(own_file);
    for (std::size_t begin = text.find('"'); begin < text.size();) {
        const std::size_t end = text.find_first_of("\"\n", begin + 1);
        if (end >= text.size()) break;
        const std::string_view path = text.substr(begin + 1, end - begin - 1);
        if (text[end] == '"' && path_beside(sources.name(own_file), path) == sources.name(file))
            return {own_file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end + 1)};
        begin = text.find('"', end + 1);
    }
    return {};
}

/// The place in the model's own text by which it uses the file of a finding; unknown where nobody tells.
Span use_of(const Diagnostic& finding, FileId file, const SourceMap& sources) {
    for (const Note& note : finding.notes) {
        const Span span = written(note.span, sources);
        if (span.known() && span.file == own_file) return span;
    }
    return naming(file, sources);
}

nlohmann::json finding_json(const Diagnostic& finding, const SourceMap& sources) {
    Span span = written(finding.span, sources);
    std::string text = finding.message;
    if (span.known() && span.file != own_file) {
        text = fmt::format("{}, line {}: {}", sources.name(span.file),
                           sources.position(span.file, span.begin).line, text);
        span = use_of(finding, span.file, sources);
    }
    nlohmann::json json{{"severity", name_of(finding.severity)},
                        {"file", span.known() ? std::string(sources.name(span.file)) : ""},
                        {"text", text},
                        {"hint", finding.hint},
                        {"from", 0},
                        {"to", 0}};
    add_place(json, span, sources);
    return json;
}

const char* kind_name(ModelParameter::Kind kind) {
    switch (kind) {
    case ModelParameter::Kind::let:
        return "let";
    case ModelParameter::Kind::inner:
        return "inner";
    case ModelParameter::Kind::setting:
        break;
    }
    return "setting";
}

nlohmann::json parameter_json(const ModelParameter& parameter, const SourceMap& sources) {
    nlohmann::json json{{"name", parameter.name},
                        {"value", parameter.value},
                        {"literal", parameter.literal},
                        {"kind", kind_name(parameter.kind)},
                        {"least", nullptr},
                        {"most", nullptr}};
    if (parameter.kind == ModelParameter::Kind::inner) json["least"] = 0, json["most"] = 1;
    add_place(json, parameter.span, sources);
    return json;
}

/// From the eye to the depth of the model's middle, or of the point that a zoom is about.
double distance_of(const ViewedModel& viewed, bool is_zoomed) {
    const Camera& camera = viewed.view.camera;
    const Box& box = viewed.model->bounds[viewed.model->graph.root].box;
    const Vec3 middle = is_zoomed || box.empty() ? Vec3(0.0) : box.centre();
    const double depth = glm::dot(middle - camera.location, camera.direction);
    return depth > 0 ? depth : std::max(glm::length(middle - camera.location), least_size);
}

} // namespace

nlohmann::json box_json(const Box& box) {
    if (box.empty()) return nullptr;
    return {{"least", vector_json(box.min)}, {"most", vector_json(box.max)}};
}

nlohmann::json vector_json(Vec3 vector) {
    return {vector.x, vector.y, vector.z};
}

nlohmann::json camera_json(const Camera& camera, double distance) {
    nlohmann::json json{{"location", vector_json(camera.location)},
                        {"look_at", vector_json(camera.location + distance * camera.direction)},
                        {"up", vector_json(camera.up)}};
    if (camera.orthographic)
        json["width"] = camera.width;
    else
        json["angle_deg"] = camera.angle_deg;
    return json;
}

nlohmann::json findings_message(std::uint32_t number, const Compilation& compilation) {
    nlohmann::json findings = nlohmann::json::array();
    for (const Diagnostic& finding : compilation.diagnostics.all())
        findings.push_back(finding_json(finding, compilation.sources));
    if (!compilation.status.ok())
        findings.push_back(
            {{"severity", "error"}, {"file", ""}, {"text", compilation.status.message()}, {"hint", ""}});
    return {{"type", "findings"}, {"number", number}, {"findings", std::move(findings)}};
}

nlohmann::json progress_message(std::uint32_t id, const FileShare& share) {
    return {{"type", "progress"}, {"number", id}, {"stage", share.stage}, {"share", share.share}};
}

bool is_news(const FileShare& share, const FileShare& told) {
    constexpr double steps = 1000;
    return share.stage != told.stage || std::floor(steps * share.share) > std::floor(steps * told.share);
}

nlohmann::json pass_message(std::uint32_t number, const ShownPass& shown) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? nlohmann::json(*value) : nlohmann::json();
    };
    return {{"type", "pass"},
            {"number", number},
            {"pass", shown.pass},
            {"samples", shown.samples},
            {"seconds_left", or_null(shown.seconds_left)},
            {"noise_255", or_null(shown.noise_255)},
            {"error_px", shown.error_px},
            {"whole_seconds", or_null(shown.whole_seconds)},
            {"done", shown.done}};
}

nlohmann::json model_message(const StudioState& state, const LoweredModel& lowered,
                             const AnalysedModel& analysed, const ViewedModel& viewed,
                             const SourceMap& sources) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const ModelParameter& parameter : lowered.notes.parameters)
        parameters.push_back(parameter_json(parameter, sources));
    const Box& box = viewed.model->bounds[viewed.model->graph.root].box;
    const std::optional<unsigned> levels = levels_of(analysed, state.stages.lower.steps);
    nlohmann::json message{
        {"type", "model"},
        {"number", state.number},
        {"parameters", std::move(parameters)},
        {"camera",
         camera_json(viewed.view.camera, distance_of(viewed, state.stages.view.zoom.zoom.has_value()))},
        {"box", box_json(box)},
        {"stats", nlohmann::json::parse(stats_json(analysed, levels, sources))},
        {"chance", lowered.notes.asks_chance},
        {"grows", !lowered.notes.derivation || lowered.notes.derivation->grows}};
    add_maps(message, state, analysed);
    return message;
}

} // namespace graftal
