#include "runtime/studio/pointer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "compiler/editing/positions.h"
#include "compiler/session/stages.h"
#include "compiler/support/number_range.h"
#include "compiler/zoom/focus.h"
#include "runtime/studio/address_text.h"
#include "runtime/studio/message_reader.h"
#include "runtime/studio/model_message.h"
#include "runtime/trace/camera_rays.h"

namespace graftal {

namespace {

/// The pass after which objects still have the names of the text.
constexpr const char* last_named_pass = "drop_unreachable";
/// Parts smaller than this are not looked into.
constexpr double least_px = 1;
/// Parts that a ray of the pointer is asked against.
constexpr std::uint64_t most_looks = 100'000;
/// A click this far off is still meant for what is there.
constexpr double reach_px[] = {2, 4, 7};
/// The last part of an address is at least this large.
constexpr double address_px = 16;
/// Times that the whole is larger than the picture, beyond which the graph gets a new root, and below which
/// it has its own again.
constexpr double most_plain = 60, least_rooted = 30;
/// Without a new root, digits end a camera's way.
constexpr double most_without_root = 1e9;
constexpr std::size_t most_remembered = 20'000;

double width_at(const Camera& camera, double depth) {
    return camera.orthographic ? camera.width : 2 * depth * std::tan(glm::radians(camera.angle_deg) / 2);
}

std::string zoom_text(const Magnification& zoom) {
    constexpr double most_exponent = 900; // of two, that doubles hold
    if (std::abs(zoom.log2()) < most_exponent) return fmt::format("{:.15g}", zoom.times(1));
    const double digits = zoom.log2() * std::log10(2.0);
    const double whole = std::floor(digits);
    return fmt::format("{:.12g}e{:.0f}", std::pow(10, digits - whole), whole);
}

} // namespace

std::shared_ptr<const ViewedModel> Pointer::view(const StageOptions& stages, std::string& problem) {
    if (!session_ || session_name_ != state_.name) {
        session_ = std::make_unique<Session>(state_.name, files_);
        session_name_ = state_.name;
        session_text_.clear();
        home_.equip(*session_);
        session_->set_control({cancel_, {}});
    }
    if (session_text_ != *state_.text) {
        session_->edit(*state_.text);
        session_text_ = *state_.text;
    }
    StageOptions named = stages;
    named.stop_after = last_named_pass;
    compilation_ = {};
    auto viewed = session_->viewed(named, compilation_);
    if (viewed) return viewed;
    problem = compilation_.status.ok() ? "this view cannot be had" : compilation_.status.message();
    for (const Diagnostic& finding : compilation_.diagnostics.all())
        if (finding.severity == Severity::error) {
            problem = finding.message;
            break;
        }
    return nullptr;
}

std::shared_ptr<const ViewedModel> Pointer::needed_view() {
    std::string problem;
    auto viewed = view(state_.stages, problem);
    if (!viewed) throw BadMessage(problem);
    return viewed;
}

std::optional<MetPart> Pointer::part_near(const ViewedModel& viewed, double x, double y) const {
    const CameraRays rays(viewed.view);
    std::optional<MetPart> met = first_part(viewed, rays.through(x, y), least_px, most_looks);
    constexpr int around = 8;
    for (const double reach : reach_px)
        for (int i = 0; i < around && !met; ++i) {
            const double angle = glm::radians(360.0 * i / around);
            met = first_part(viewed, rays.through(x + reach * std::cos(angle), y + reach * std::sin(angle)),
                             least_px, most_looks / 16);
        }
    return met;
}

std::vector<GraphStep> Pointer::whole_path(const ViewedModel& viewed,
                                           const std::vector<GraphStep>& path) const {
    if (!viewed.ways || path.empty()) return path;
    if (path.front().instance >= viewed.ways->size()) return {}; // the ground, which no address leads to
    std::vector<GraphStep> whole = viewed.ways->path(path.front().instance);
    whole.insert(whole.end(), path.begin() + 1, path.end());
    return whole;
}

nlohmann::json Pointer::pick(double x, double y) {
    const auto viewed = needed_view();
    const std::optional<MetPart> met = part_near(*viewed, x, y);
    if (!met) return nlohmann::json::object();
    const Graph& graph = viewed->model->graph;
    std::vector<GraphStep> path = whole_path(*viewed, met->path);
    Span span;
    nlohmann::json names = nlohmann::json::array(), part = nlohmann::json::array();
    for (const GraphStep& step : path) {
        part.push_back(step.instance);
        const Instance& instance = graph.objects[step.object].instances[step.instance];
        if (instance.span.known()) span = instance.span;
        if (!graph.objects[instance.master].primitive) names.push_back(graph.objects[instance.master].name);
    }
    while (!path.empty() && graph.objects[end_of(graph, path)].primitive)
        path.pop_back();
    nlohmann::json answer{
        {"point", vector_json(met->point)},   {"normal", vector_json(met->normal)},
        {"address", address_of(graph, path)}, {"object", graph.objects[end_of(graph, path)].name},
        {"path", std::move(names)},           {"part", std::move(part)}};
    if (span.known() && span.file == FileId{0}) {
        const TextPositions positions(compilation_.sources.text(span.file));
        answer["from"] = positions.utf16_of(span.begin);
        answer["to"] = positions.utf16_of(span.end);
    }
    return answer;
}

Pointer::Place Pointer::current() const {
    return {state_.at, state_.zoom, state_.camera, state_.stages.view.camera};
}

nlohmann::json Pointer::zoom(const Grip& grip) {
    constexpr double same_px = 1.5, same_factor = 1e-9;
    const auto is_undone = [&](const Grip& before) {
        return std::hypot(before.x + before.dx - grip.x, before.y + before.dy - grip.y) < same_px &&
               std::hypot(before.dx + grip.dx, before.dy + grip.dy) < same_px &&
               std::abs(before.factor * grip.factor - 1) < same_factor;
    };
    const Place from = current();
    Place to;
    const auto back = std::find_if(steps_.rbegin(), steps_.rend(),
                                   [&](const Step& step) { return step.to == from && is_undone(step.grip); });
    if (back != steps_.rend()) {
        to = back->from;
    } else {
        to = nearer(*needed_view(), grip);
        steps_.push_back({from, to, grip});
        if (steps_.size() > most_remembered) steps_.pop_front();
    }
    return {{"at", to.at.empty() ? nlohmann::json() : nlohmann::json(to.at)},
            {"zoom", to.zoom.empty() ? nlohmann::json() : nlohmann::json(to.zoom)},
            {"camera", to.camera ? *to.camera : nlohmann::json()}};
}

Pointer::Place Pointer::placed(std::string at, std::string zoom, nlohmann::json camera) {
    CameraOverride override = read_camera(camera);
    return {std::move(at), std::move(zoom), std::move(camera), override};
}

/// A camera that sees the point so much larger, without a zoom of its graph.
Camera Pointer::dollied(const Camera& camera, Vec3 point, double factor) {
    Camera nearer = camera;
    const Vec3 from_point = camera.location - point;
    nearer.location = point + from_point / factor;
    if (!camera.orthographic) return nearer;
    // Parallel rays begin where they did: parts lie in between.
    const double before = glm::dot(from_point, camera.direction);
    nearer.location += (before - before / factor) * camera.direction;
    nearer.width /= factor;
    return nearer;
}

Pointer::Place Pointer::nearer(const ViewedModel& viewed, const Grip& grip) {
    const Camera& camera = viewed.view.camera;
    StageOptions named = state_.stages;
    named.stop_after = last_named_pass;
    const auto whole = session_->analysed(named, compilation_);
    if (!whole) throw BadMessage("the model has no bounds");
    const ObjectBounds& bounds = whole->bounds[whole->graph.root];
    const double radius = std::max(bounds.ball.radius, least_size);
    const bool is_zoomed = state_.stages.view.zoom.zoom.has_value();
    const Magnification zoom = is_zoomed ? *state_.stages.view.zoom.zoom : Magnification();

    const std::optional<MetPart> met = part_near(viewed, grip.x, grip.y);
    const Vec3 middle = is_zoomed || bounds.box.empty() ? Vec3(0.0) : bounds.box.centre();
    double depth = glm::dot((met ? met->point : middle) - camera.location, camera.direction);
    if (!(depth > 0)) depth = radius;
    // The part may lie beside the pixel: the point is the pixel's.
    const Ray ray = CameraRays(viewed.view).through(grip.x, grip.y);
    const double before = glm::dot(ray.origin - camera.location, camera.direction);
    const Vec3 point = ray((depth - before) / glm::dot(ray.direction, camera.direction));
    Camera nearer = dollied(camera, point, grip.factor);
    const double distance = camera.orthographic ? depth : depth / grip.factor;
    const double unit_of_px = width_at(nearer, distance) / viewed.view.size.width;
    nearer.location -= unit_of_px * (grip.dx * camera.right - grip.dy * camera.up);
    const double enlarged = zoom.times(radius) / width_at(nearer, distance);

    if (is_zoomed) {
        if (!(enlarged < least_rooted)) return rooted(viewed, met, nearer, distance, zoom, grip.factor);
        const double smaller = 1 / zoom.times(1);
        Camera own = nearer;
        own.location = focus_in_world(*whole) + smaller * nearer.location;
        own.width *= smaller;
        return placed("", "", camera_json(own, smaller * distance));
    }
    const bool has_way = met && state_.at.empty();
    if (enlarged > most_plain && has_way) {
        const double scale = std::exp2(std::round(std::log2(enlarged)));
        try {
            return rooted(viewed, met, nearer, distance, zoom, scale);
        } catch (const BadMessage&) { // through a flat map, say
            if (enlarged > most_without_root) throw;
        }
    }
    if (enlarged > most_without_root) throw BadMessage("there is no address to zoom at further");
    return placed(state_.at, "", camera_json(nearer, distance));
}

Vec3 Pointer::focus_in_world(const AnalysedModel& whole) const {
    if (!whole.at) return whole.bounds[whole.graph.root].box.centre();
    return focus_of_path(whole.graph, whole.bounds, *whole.at).points.front();
}

/// A view about a part's middle: lengths are `scale` times as large as in the one before, in which `camera`
/// is.
Pointer::Place Pointer::rooted(const ViewedModel& viewed, const std::optional<MetPart>& met, Camera camera,
                               double distance, const Magnification& zoom, double scale) {
    const Graph& graph = viewed.model->graph;
    std::string at = state_.at;
    Vec3 middle(0.0);
    if (met) {
        std::vector<GraphStep> path = met->path;
        const auto is_fit = [&] {
            const ObjectId end = end_of(graph, path);
            const double size =
                2 * norm(world_from_end(graph, path).linear) * viewed.model->bounds[end].ball.radius;
            return !graph.objects[end].primitive &&
                   size * viewed.view.camera.pixels_per_unit(met->point, viewed.view.size.width) > address_px;
        };
        while (path.size() > 1 && !is_fit())
            path.pop_back();
        const std::vector<GraphStep> whole = whole_path(viewed, path);
        if (whole.empty() && !viewed.ways) throw BadMessage("the model has no parts to zoom at");
        if (!whole.empty()) {
            middle = world_from_end(graph, path)(viewed.model->bounds[end_of(graph, path)].ball.centre);
            at = address_of(graph, whole);
        }
    }
    camera.location = scale * (camera.location - middle);
    camera.width *= scale;
    distance *= scale;
    if (camera.orthographic) {
        // Parts before the picture are in reach of it (zoom/reroot.cpp).
        constexpr double before = 20;
        const Vec3 aside = camera.location - glm::dot(camera.location, camera.direction) * camera.direction;
        camera.location = aside - before * camera.width * camera.direction;
        distance = before * camera.width;
    }
    Place place = placed(at, zoom_text(zoom * Magnification::of(scale)), camera_json(camera, distance));
    StageOptions stages = state_.stages;
    std::string problem;
    stages.view.zoom = read_zoom(place.at, place.zoom);
    stages.view.zoom.eye = place.override.location;
    stages.view.camera = place.override;
    if (!view(stages, problem)) throw BadMessage(problem);
    return place;
}

} // namespace graftal
