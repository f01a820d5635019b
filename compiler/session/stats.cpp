#include "compiler/session/stats.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/analysis/counts.h"
#include "compiler/analysis/volume.h"
#include "compiler/languages/lower.h"
#include "compiler/session/analyse_shapes.h"
#include "compiler/session/frame_model.h"
#include "compiler/support/printable.h"

namespace graftal {

namespace {

constexpr StatsKey keys[] = {
    {"model", "the file"},
    {"language", "the language that it is written in"},
    {"objects", "different parts of the model; graftal keeps equal parts once"},
    {"instances", "placements of parts within parts"},
    {"written objects", "the same before graftal has merged equal parts"},
    {"written instances", "the same before graftal has merged equal parts"},
    {"steps", "derivation steps or levels of recursion; - if they have no end"},
    {"primitives",
     "spheres, cylinders, polygons and other simple shapes in the whole figure, exactly; - if they "
     "have no end"},
    {"contraction verdict",
     "whether parts within themselves shrink: proved, refuted or undecided; acyclic if "
     "no part contains itself"},
    {"contraction rate", "size of a part relative to the part around it, on the cycle that shrinks least"},
    {"contraction cycle", "the parts of this cycle"},
    {"contraction lower", "the true rate of the model is at least this"},
    {"contraction upper", "the true rate of the model is at most this"},
    {"contraction certificate rate", "the rate that the proof uses; below 1, so the model converges"},
    {"contraction certificate depth", "how many placements deep the proof looks"},
    {"contraction certificate holds", "whether a second check of the proof succeeds"},
    {"dimension", "similarity dimension: 1 for a line, 2 for a surface, between them for a fern; right where "
                  "copies do not overlap"},
    {"boxes", "- if too few sides of boxes were counted for a slope (--boxes)"},
    {"boxes dimension",
     "slope of the boxes that the figure meets over their side, both as logarithms (--boxes)"},
    {"boxes error", "standard error of this slope"},
    {"boxes least", "least slope from one side to its half"},
    {"boxes most", "greatest slope from one side to its half"},
    {"boxes sides", "greatest and least side of the boxes that the slope is of"},
    {"boxes counts", "boxes of each of these sides, the greatest first"},
    {"bounds", "- if the figure has none"},
    {"bounds min",
     "least x, y and z of a box that contains the figure: of its limit, if it has over 200 levels"},
    {"bounds max", "greatest x, y and z of this box"},
    {"volume", "- if a plane has no end, or graftal would take too long to find it"},
    {"volume least",
     "volume that the solids of the figure enclose together, at least: those that may overlap "
     "count once"},
    {"volume most",
     "the same at most: those that may overlap count each. Both are equal where graftal knows it exactly"},
    {"unbounded", "whether the model has an endless plane, which the bounds leave out"},
    {"error", "largest distance of a point from its exact place, in the model's units"},
    {"time", "age of the plant in steps, with the elapsed share of the next step"},
    {"modules", "letters of the word that the rules make, exactly"},
    {"segments", "lines that the word draws, such as internodes, exactly"},
    {"compiled way", "composed of parts, derived letter by letter, or folded into a cycle without end"},
    {"compiled parts", "different parts that graftal composed the plant of"},
    {"compiled size_step", "how far graftal rounded sizes, as a step of their natural logarithm"},
    {"compiled variants", "versions that graftal made of each random part"},
    {"compiled drift", "error of the mean number of segments and shapes over these versions; 0.05 is 5 %"},
    {"families parameters", "the inner parameters of a model that is placed with `~`"},
    {"families members", "different leaves or other members that the plant places"},
    {"families possible", "members that the parameters can choose among"},
    {"families error", "largest distance of an argument from the value that stands for it"},
};

using Json = nlohmann::ordered_json;

const char* name_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::acyclic:
        return "acyclic";
    case Verdict::proved:
        return "proved";
    case Verdict::refuted:
        return "refuted";
    case Verdict::undecided:
        return "undecided";
    }
    return "";
}

template<typename Value> Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json vector_json(Vec3 v) {
    return Json::array({v.x, v.y, v.z});
}

Json contraction_json(const AnalysedModel& model) {
    const Contraction& contraction = model.contraction;
    const bool cyclic = contraction.verdict != Verdict::acyclic;
    Json cycle = Json::array();
    for (const GraphStep& step : contraction.worst_cycle)
        cycle.push_back(model.graph.objects[step.object].name);
    Json json = {{"verdict", name_of(contraction.verdict)},
                 {"rate", cyclic ? Json(contraction.rate()) : Json(nullptr)},
                 {"cycle", cyclic ? std::move(cycle) : Json(nullptr)}};
    if (!cyclic) return json;
    json["lower"] = contraction.lower;
    json["upper"] = contraction.upper;
    if (contraction.verdict == Verdict::proved)
        json["certificate"] = {
            {"rate", contraction.certificate.rate},
            {"depth", contraction.certificate.depth},
            {"holds", certificate_holds(model.graph, model.components, contraction.certificate)}};
    return json;
}

/// The box of a figure of few levels: it may be a part of the limit set, and terminals may reach beyond that.
Json bounds_json(const AnalysedModel& model, std::optional<unsigned> steps) {
    if (model.bounds.empty() || model.bounds[model.graph.root].box.empty()) return nullptr;
    const Box box = sight_of(model, steps).bounds;
    return {{"min", vector_json(box.min)}, {"max", vector_json(box.max)}};
}

Json volume_json(const AnalysedModel& model, std::optional<unsigned> steps) {
    if (model.bounds.empty()) return nullptr;
    const std::optional<VolumeRange> volume =
        volume_range(model.graph, model.components, model.bounds, steps);
    return volume ? Json{{"least", volume->least}, {"most", volume->most}} : Json(nullptr);
}

/// Families by the name of their model.
Json families_json(const Derivation& derivation) {
    Json families = Json::object();
    for (const FamilyReport& family : derivation.families)
        families[family.model] = {{"parameters", family.parameters},
                                  {"members", family.used},
                                  {"possible", family.possible},
                                  {"error", family.error}};
    return families;
}

Json boxes_json(const BoxCount& boxes) {
    if (boxes.dimension == 0) return nullptr;
    Json counts = Json::array();
    for (std::size_t i = boxes.first_row; i < boxes.rows.size(); ++i)
        counts.push_back(boxes.rows[i].boxes);
    return {{"dimension", boxes.dimension},
            {"error", boxes.error},
            {"least", boxes.least_slope},
            {"most", boxes.most_slope},
            {"sides", Json::array({boxes.rows[boxes.first_row].side, boxes.rows.back().side})},
            {"counts", std::move(counts)}};
}

Json json_of(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources,
             const BoxCount* boxes) {
    const Graph& graph = model.graph;
    const bool empty = graph.objects.empty();
    Json json = {
        {"model", model.path},
        {"language", model_language(sources)},
        {"objects", graph.objects.size()},
        {"instances", edge_count(graph)},
        {"written", {{"objects", model.written.objects}, {"instances", model.written.instances}}},
        {"steps", or_null(model.derivation ? model.derivation->steps : steps)},
        {"primitives", empty ? Json("0") : or_null(count_leaves(graph, model.components, steps))},
        {"contraction", contraction_json(model)},
        {"dimension", !empty && converges(model.contraction)
                          ? or_null(similarity_dimension(graph, model.components))
                          : Json(nullptr)},
    };
    if (boxes) json["boxes"] = boxes_json(*boxes);
    json.update({
        {"bounds", bounds_json(model, steps)},
        {"volume", volume_json(model, steps)},
        {"unbounded", !model.bounds.empty() && model.bounds[graph.root].unbounded},
        {"error", model.derivation ? model.derivation->error : 0},
    });
    if (const std::optional<Derivation>& derivation = model.derivation) {
        if (derivation->timed) json["time"] = derivation->time;
        const bool finite = derivation->steps.has_value();
        json["modules"] = finite ? Json(derivation->modules) : Json(nullptr);
        json["segments"] = finite ? Json(derivation->segments) : Json(nullptr);
        json["compiled"] = {{"way", derivation->way}, {"parts", derivation->parts}};
        if (derivation->size_step > 0) json["compiled"]["size_step"] = derivation->size_step;
        if (derivation->variants > 1) {
            json["compiled"]["variants"] = derivation->variants;
            json["compiled"]["drift"] = derivation->drift;
        }
        if (!derivation->families.empty()) json["families"] = families_json(*derivation);
    }
    return json;
}

std::string text_of(const Json& value) {
    if (value.is_string()) {
        const std::string text = value.get<std::string>();
        return escaped(text, text.size());
    }
    if (!value.is_array()) return value.is_null() ? "-" : value.dump();
    std::string text;
    for (const Json& item : value)
        text += (text.empty() ? "" : " ") + text_of(item);
    return text;
}

/// One line a key; the keys of nested objects behind the outer one.
void append_lines(const Json& json, const std::string& prefix, std::string& out) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object())
            append_lines(value, prefix + key + " ", out);
        else
            out += fmt::format("{:<28} {}\n", prefix + key, text_of(value));
    }
}

} // namespace

std::string stats_json(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources,
                       const BoxCount* boxes) {
    Json json = json_of(model, steps, sources, boxes);
    json["leaves"] = json["primitives"]; // its former name, for one version
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string stats_text(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources,
                       const BoxCount* boxes) {
    std::string text;
    append_lines(json_of(model, steps, sources, boxes), "", text);
    return text;
}

std::span<const StatsKey> stats_keys() {
    return keys;
}

} // namespace graftal
