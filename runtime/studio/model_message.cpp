#include "runtime/studio/model_message.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/editing/positions.h"
#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
#include "compiler/support/number_range.h"
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

nlohmann::json finding_json(const Diagnostic& finding, const SourceMap& sources) {
    const Span span = written(finding.span, sources);
    nlohmann::json json{{"severity", name_of(finding.severity)},
                        {"file", span.known() ? std::string(sources.name(span.file)) : ""},
                        {"text", finding.message},
                        {"hint", finding.hint}};
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
        {"stats", nlohmann::json::parse(stats_json(analysed, levels, sources))}};
    add_maps(message, state, analysed);
    return message;
}

} // namespace graftal
