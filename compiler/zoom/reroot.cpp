#include "compiler/zoom/reroot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/graph/path.h"
#include "compiler/scene/framing.h"
#include "compiler/support/number_range.h"
#include "compiler/support/stage_price.h"
#include "compiler/zoom/focus.h"
#include "compiler/zoom/neighbourhood.h"
#include "compiler/zoom/zoom_scale.h"

namespace graftal {

namespace {

/// Reach about the focus, in distances of the eye. Parts farther away are left out, with their shadows and
/// where they are seen between the nearer parts.
constexpr double reach_share = 200;
/// Reach of parallel rays, in half diagonals of the picture; flat models have nothing out of the picture.
constexpr double parallel_share = 16, flat_reach_share = 1.05;
/// A map that stretches space so much more one way than another leaves no digits.
constexpr double worst_condition = 1e8;
/// Largest movement of a part by rounding that is not worth a word.
constexpr double visible_px = 0.25;
/// A primitive this much larger than all that is in reach looks like a plane, and POV-Ray loses its place.
constexpr double largest_primitive = 1e3;

/// The rotation, or reflection, that turns y and the half plane of x as the map does.
Mat3 upright_rotation(const Mat3& map) {
    const Vec3 y = glm::normalize(map[1]);
    const Vec3 x = glm::normalize(map[0] - glm::dot(map[0], y) * y);
    const Vec3 z = glm::cross(x, y);
    return {x, y, glm::determinant(map) < 0 ? -z : z};
}

class Rerooter {
  public:
    Rerooter(const ZoomModel& model, const ZoomRequest& request, const FrameObject& frame_object,
             Diagnostics& diagnostics, const Control& control)
        : model_(model), request_(request), frame_object_(frame_object), diagnostics_(diagnostics),
          meter_(control, "frame", 1 << 14, StagePrice::near),
          around_(model.graph, model.components, model.bounds, model.steps, meter_) {}

    std::optional<Rerooted> run(const std::optional<Vec3>& look_at) {
        if (!find_focus(look_at)) return std::nullopt;
        ZoomScale scale = request_.zoom ? ZoomScale::about_focus(model_.graph, focus_, *request_.zoom)
                                        : ZoomScale::of_last_object(model_.graph, focus_);
        result_.zoom = scale.zoom();
        if (!set_view(look_at, scale.picture_from_frame()) || !descend(scale)) return std::nullopt;
        const Affine picture_from_frame = *scale.picture_from_frame();
        return place(picture_from_frame) ? std::optional(std::move(result_)) : std::nullopt;
    }

  private:
    Span span() const { return model_.graph.objects[model_.graph.root].span; }

    bool refuse(std::string message, std::string hint) {
        diagnostics_.error(span(), std::move(message)).with_hint(std::move(hint));
        return false;
    }

    bool find_focus(const std::optional<Vec3>& look_at) {
        if (model_.at) {
            if (model_.at->endless() && !request_.zoom)
                return refuse("an endless address is a point, and a point has no frame of its own",
                              "give the repetition a count, or give a magnification with --zoom F");
            for (const std::vector<GraphStep>* steps : {&model_.at->steps, &model_.at->cycle})
                for (const GraphStep& step : *steps)
                    if (model_.graph.objects[step.object].is_combined()) return refuse_combined(step);
            focus_ = focus_of_path(model_.graph, model_.bounds, *model_.at);
        } else if (look_at) {
            focus_ = focus_at_point(model_.graph, model_.bounds, *look_at);
        } else {
            const Box& box = model_.bounds[model_.graph.root].box;
            const Vec3 to_eye = -frame_object_(model_.graph.root, 0).camera.direction;
            focus_ = focus_near_point(model_.graph, model_.bounds, box.empty() ? Vec3(0.0) : box.centre(),
                                      *request_.zoom, to_eye);
        }
        return true;
    }

    bool set_view(const std::optional<Vec3>& look_at, const std::optional<Affine>& picture_from_root) {
        if (request_.zoom) {
            result_.view = frame_object_(model_.graph.root, 0);
            result_.view.catcher.reset(); // the catcher lies under the whole model
            turn_to_focus(look_at.value_or(focus_.points.front()));
        } else if (!look_from_object(picture_from_root)) {
            return false;
        }
        const View& view = result_.view;
        const Vec3 focus = focus_in_picture();
        const Vec3 from_eye = focus - view.camera.location;
        if (view.camera.orthographic) {
            const double aspect = static_cast<double>(view.size.width) / view.size.height;
            const double half_diagonal = 0.5 * view.camera.width * std::hypot(1, 1 / aspect);
            const Vec3 aside = from_eye - glm::dot(from_eye, view.camera.direction) * view.camera.direction;
            const bool flat = thickness(model_.bounds[model_.graph.root].box) <= flat_share;
            reach_ = glm::length(aside) + half_diagonal * (flat ? flat_reach_share : parallel_share);
        } else {
            reach_ = reach_share * glm::length(from_eye);
        }
        return true;
    }

    Vec3 focus_in_picture() const { return request_.zoom ? Vec3(0.0) : focus_.points.back(); }

    /// The picture's origin is the focus now, and the camera looks at it from where it was.
    void turn_to_focus(Vec3 world_focus) {
        View& view = result_.view;
        Camera& camera = view.camera;
        const double radius = model_.bounds[model_.graph.root].ball.radius;
        const double depth = glm::dot(world_focus - camera.location, camera.direction);
        camera.location = request_.eye.value_or(-std::max(depth, 1e-3 * radius) * camera.direction);
        view.lens = {}; // its depth is that of the camera before
        const double zoom = request_.zoom->times(1);
        for (Light& light : view.lights)
            if (!light.sun)
                move(light, zoom * (light.location - world_focus), light.location - world_focus, Mat3(zoom));
        if (view.haze) {
            view.haze->base = request_.zoom->times(view.haze->base - world_focus.y);
            view.haze->height = request_.zoom->times(view.haze->height);
            view.haze->distance = request_.zoom->times(view.haze->distance);
            if (!is_sound(*view.haze)) view.haze.reset();
        }
        if (!view.ground) return;
        scale_lengths(view.ground->material);
        const double height = request_.zoom->times(view.ground->height - world_focus.y);
        if (std::abs(height) <= farthest_ground())
            view.ground->height = height;
        else
            view.ground.reset();
    }

    /// Scales those of the world, whose measure an object's own frame does not know.
    void scale_lengths(Material& material) const {
        material.absorption =
            request_.zoom ? std::min(request_.zoom->times(material.absorption), largest_size) : 0;
        if (!request_.zoom) return;
        for (PatternLayer& layer : material.pattern.layers)
            if (layer.of_world)
                layer.scale = std::clamp(request_.zoom->times(layer.scale), least_size, largest_size);
    }

    /// Beyond these lengths nothing of it is seen.
    static bool is_sound(const Haze& haze) {
        return is_size(haze.distance) &&
               (haze.is_even() || (is_size(haze.height) && is_place(Vec3(haze.base))));
    }

    /// A light beyond all distances is a sun, and a lamp reaches no farther. One at the focus, of no
    /// direction, stays there. `linear`: of its sides.
    void move(Light& light, Vec3 location, Vec3 direction, const Mat3& linear) {
        const double far = 1e3 * glm::length(result_.view.camera.location);
        const bool at_focus = !light.sun && direction == Vec3(0.0);
        if (at_focus && !std::isfinite(glm::length(location))) location = focus_in_picture();
        light.sun = !at_focus && !(glm::length(location) <= far);
        light.location = light.sun ? glm::normalize(direction) : location;
        for (Vec3* const side : {&light.a, &light.b}) {
            const Vec3 moved = linear * *side;
            const double length = glm::length(moved);
            if (light.sun || length <= far)
                *side = light.sun ? Vec3(0.0) : moved;
            else if (*side != Vec3(0.0))
                *side = far * glm::normalize(*side);
        }
    }

    double farthest_ground() const { return reach_share * glm::length(result_.view.camera.location); }

    bool look_from_object(const std::optional<Affine>& picture_from_root) {
        const GraphPath& path = focus_.path;
        ObjectId object = model_.graph.root;
        unsigned levels = 0;
        Mat3 world_from_object(1.0);
        for (const GraphStep& step : path.steps) {
            const Instance& instance = model_.graph.objects[step.object].instances[step.instance];
            object = instance.master;
            levels += levels_of(instance, model_.components);
            world_from_object = world_from_object * instance.parent_from_child.linear;
            const double most = largest_entry(world_from_object);
            if (most > 0) world_from_object = world_from_object * std::ldexp(1.0, -std::ilogb(most));
        }
        if (model_.steps && levels > *model_.steps) return refuse_depth(levels);
        result_.view = frame_object_(object, levels);
        if (!path.steps.empty() && !is_singular({world_from_object, {}}))
            keep_surroundings(inverse(Affine{world_from_object, {}}).linear, picture_from_root);
        return true;
    }

    /// Lights, sky and ground stay where they are in the world. `turn`: directions of the world in the
    /// picture; `picture_from_root`: nothing where the world is too large to be seen from here.
    void keep_surroundings(const Mat3& turn, const std::optional<Affine>& picture_from_root) {
        View& view = result_.view;
        view.haze.reset(); // its lengths are those of the world
        view.lens = {};
        view.catcher.reset();
        const Vec3 infinitely_far(std::numeric_limits<double>::infinity());
        if (!model_.graph.settings.lights.empty())
            for (Light& light : view.lights) {
                const Vec3 towards = light.sun ? light.location : light.location - focus_.points.front();
                const bool near = !light.sun && picture_from_root;
                move(light, near ? (*picture_from_root)(light.location) : infinitely_far, turn * towards,
                     near ? picture_from_root->linear : turn);
            }
        if (model_.graph.settings.sky) {
            SkyLight& sky = *view.sky_light;
            sky.up = glm::normalize(turn * sky.up);
            sky.picture_from_world = sky.picture_from_world * glm::transpose(upright_rotation(turn));
            if (sky.clear) sky.clear->to_sun = glm::normalize(turn * sky.clear->to_sun);
        }
        if (model_.graph.settings.background && view.sky.zenith != view.sky.horizon)
            view.sky.axis = glm::normalize(turn * view.sky.axis);
        if (view.ground && picture_from_root) {
            // No longer level, it is a plane like others.
            const Affine world_from_plane = Affine::translate({0, view.ground->height, 0});
            ground_ = {*picture_from_root * world_from_plane, view.ground->material};
            scale_lengths(ground_->material);
        }
        view.ground.reset();
    }

    bool refuse_depth(unsigned levels) {
        return refuse(fmt::format("the address is {} levels deep, but --steps ends the model after {}",
                                  levels, *model_.steps),
                      "give a larger --steps or a shorter address");
    }

    /// Nothing while the frame is so large that no digit of the picture is left in it.
    std::optional<Affine> picture_from_frame(const ZoomScale& scale) const {
        constexpr double largest = 1e40;
        std::optional<Affine> map = scale.picture_from_frame();
        if (map && norm(map->linear) * around_.radius(around_.own()) > largest * reach_) map.reset();
        return map;
    }

    double stretch(const ZoomScale& scale) const {
        const std::optional<Affine> map = picture_from_frame(scale);
        return map ? norm(map->linear) : std::numeric_limits<double>::infinity();
    }

    /// Reach of the frame: the parts that may be seen in the picture.
    double frame_reach(const ZoomScale& scale) const {
        const std::optional<Affine> map = picture_from_frame(scale);
        return map ? reach_ / std::max(singular_values(map->linear).z, 1e-300) : 0.0;
    }

    bool own_fits(const ZoomScale& scale) const {
        return stretch(scale) * around_.radius(around_.own()) <= reach_;
    }

    /// Down the path until the object reached is no larger than the picture's reach.
    bool descend(ZoomScale& scale) {
        using Outcome = Neighbourhood::Outcome;
        const GraphPath& path = focus_.path;
        while (!own_fits(scale) && (path.endless() || result_.depth < path.steps.size())) {
            ZoomScale below = scale;
            below.descend();
            const GraphStep& step = path.at(result_.depth);
            const Vec3 focus = focus_.at(result_.depth + 1);
            const Outcome outcome = around_.descend(step.instance, focus, frame_reach(below));
            if (outcome == Outcome::flat) return refuse_flat(step);
            if (outcome == Outcome::too_many) return refuse_crowd();
            if (outcome == Outcome::no_level && model_.at) return refuse_depth(around_.own().levels + 1);
            if (outcome == Outcome::no_level) break;
            scale = below;
            ++result_.depth;
        }
        return spread(scale);
    }

    /// Where the path ends before the object reached is small, its parts are.
    bool spread(const ZoomScale& scale) {
        const std::optional<Affine> map = picture_from_frame(scale);
        if (!map) return refuse_end();
        const Vec3 sigma = singular_values(map->linear);
        if (sigma.x > worst_condition * sigma.z) return refuse_condition(sigma.x / sigma.z);
        whole_ = own_fits(scale);
        if (whole_) return sigma.x >= least_size || refuse_nothing();
        const double rounding = std::numeric_limits<double>::epsilon() * around_.radius(around_.own());
        if (px(sigma.x * std::max(focus_.error, rounding)) > visible_px) return refuse_end();
        return around_.spread(focus_.at(result_.depth), frame_reach(scale), reach_ / sigma.x) ||
               refuse_crowd();
    }

    bool refuse_flat(const GraphStep& step) {
        const Instance& instance = model_.graph.objects[step.object].instances[step.instance];
        return refuse(
            fmt::format("the address leads through '{}', which flattens space: there is no way back "
                        "from its frame to the world around it",
                        model_.graph.objects[instance.master].name),
            "choose an address that avoids it");
    }

    bool refuse_combined(const GraphStep& step) {
        const Object& object = model_.graph.objects[step.object];
        return refuse(
            fmt::format("the address leads into '{}', whose parts are not drawn by themselves: it is "
                        "their {}",
                        object.name,
                        object.combination == Combination::subtract ? "difference" : "intersection"),
            fmt::format("let the address end at '{}', or draw the part as an object of its own",
                        object.name));
    }

    bool refuse_crowd() {
        return refuse(around_.looked_too_often()
                          ? fmt::format("more than {} parts may reach this place", Neighbourhood::most_looks)
                          : fmt::format("more than {} parts of one size crowd around this place",
                                        Neighbourhood::most_pieces),
                      "zoom in less, or choose another address");
    }

    bool refuse_condition(double condition) {
        return refuse(fmt::format("the maps on the way stretch space {:.2g} times more in one direction than "
                                  "in another: no digits remain for the surroundings",
                                  condition),
                      "zoom in less, or choose an address along similarities");
    }

    /// Where nothing recurs, a place is known to as many digits as a number has.
    bool refuse_end() {
        if (model_.at)
            return refuse(fmt::format("the address ends after {} steps, before the zoom does",
                                      focus_.path.steps.size()),
                          "make it longer, for instance with a repetition at its end: (a.b)*");
        const bool ends = !model_.components.unending[model_.graph.root];
        return refuse("the zoom needs more digits than the point has",
                      ends ? "zoom in less: this model does not recur, so it has nothing as small as that"
                           : "give an address instead of the point: --at a.b.(c.d)*");
    }

    bool refuse_nothing() {
        return refuse(
            fmt::format("this zoom makes the whole model more than {:g} times smaller", largest_size),
            std::string("zoom out less: ") + range_hint);
    }

    double px(double picture_length) const {
        return picture_length *
               result_.view.camera.pixels_per_unit(focus_in_picture(), result_.view.size.width);
    }

    bool place(const Affine& picture_from_frame) {
        std::vector<NearPiece> pieces = around_.others();
        if (whole_) pieces.insert(pieces.begin(), around_.own());
        const double stretch = norm(picture_from_frame.linear);
        Graph& graph = result_.graph;
        graph = model_.graph;
        for (Material& material : graph.materials)
            scale_lengths(material);
        result_.bounds = model_.bounds;
        Object root;
        root.name = free_name("surroundings", graph.objects);
        root.span = span();
        ObjectBounds bounds;
        double error = 0;
        std::size_t too_large = 0;
        std::vector<std::uint32_t> ways;
        for (const NearPiece& piece : pieces) {
            const ObjectBounds& of_piece = model_.bounds[piece.object];
            const Object& object = graph.objects[piece.object];
            const bool whole = (object.primitive || object.is_combined()) && !of_piece.unbounded;
            if (whole && stretch * around_.radius(piece) > largest_primitive * reach_) {
                ++too_large;
                continue;
            }
            Instance instance;
            instance.master = piece.object;
            instance.parent_from_child = picture_from_frame * piece.frame_from_piece;
            if (instance.parent_from_child.linear == Mat3(0.0)) continue; // crushed twice, to a point
            instance.tint = straight(piece.tint);
            instance.material = piece.material;
            instance.span = root.span;
            bounds.box.include(transformed(instance.parent_from_child, of_piece.box));
            bounds.unbounded = bounds.unbounded || of_piece.unbounded;
            if (model_.components.unending[piece.object]) instance.levels = piece.levels + 1;
            root.instances.push_back(instance);
            ways.push_back(piece.way);
            error = std::max(error, stretch * piece.error);
        }
        if (ground_) add_ground(root, bounds);
        if (root.instances.empty() && too_large > 0)
            return refuse("at this zoom, one surface fills the picture",
                          "zoom in less, or choose another place with --at or look_at");
        if (root.instances.empty())
            return refuse("at this zoom, no part of the model is in the picture",
                          "zoom in less, or choose another place with --at or look_at");
        result_.ways = std::move(around_.ways());
        result_.ways.set_ends(std::move(ways));
        if (!bounds.box.empty()) bounds.ball = {bounds.box.centre(), 0.5 * glm::length(bounds.box.size())};
        graph.root = graph.add(std::move(root));
        result_.bounds.push_back(bounds);
        result_.components = strong_components(graph);
        if (model_.steps) result_.steps = *model_.steps + 1;
        warn(px(error), too_large);
        return true;
    }

    void add_ground(Object& root, ObjectBounds& bounds) {
        const Affine& map = ground_->picture_from_plane;
        const Vec3 normal = glm::normalize(glm::cross(map.linear[2], map.linear[0]));
        if (!(std::abs(glm::dot(normal, focus_in_picture() - map.translation)) <= reach_)) return;
        Graph& graph = result_.graph;
        Instance plane;
        plane.master = graph.primitive(PrimitiveKind::plane);
        if (plane.master == result_.bounds.size()) result_.bounds.push_back({{}, {}, true});
        plane.parent_from_child = map;
        plane.material = static_cast<MaterialId>(graph.materials.size());
        plane.span = root.span;
        graph.materials.push_back(ground_->material);
        graph.materials.back().name = free_name("ground", graph.materials);
        bounds.unbounded = true;
        root.instances.push_back(plane);
    }

    void warn(double error_px, std::size_t too_large) {
        if (error_px > visible_px)
            diagnostics_.warning(
                span(),
                std::isfinite(error_px)
                    ? fmt::format("rounding moves parts around this place by up to {:.2g} px", error_px)
                    : "rounding moves parts beside the eye, by any number of pixels");
        if (around_.lost() > 0)
            diagnostics_.warning(
                span(),
                fmt::format(
                    "graftal left out {} parts that may touch this place: rounding hides where they lie",
                    around_.lost()));
        if (too_large > 0)
            diagnostics_.warning(
                span(),
                fmt::format(
                    "graftal left out {} primitives that are over {} times larger than everything drawn",
                    too_large, largest_primitive));
    }

    /// The name, or the name with a number, that none of these has.
    template<typename Named>
    static std::string free_name(const std::string& base, const std::vector<Named>& all) {
        std::string name = base;
        const auto taken = [&](const Named& other) { return other.name == name; };
        for (int i = 2; std::any_of(all.begin(), all.end(), taken); ++i)
            name = fmt::format("{}{}", base, i);
        return name;
    }

    struct GroundPlane {
        Affine picture_from_plane;
        Material material;
    };

    const ZoomModel& model_;
    const ZoomRequest& request_;
    const FrameObject& frame_object_;
    Diagnostics& diagnostics_;
    Focus focus_;
    WorkMeter meter_;
    Neighbourhood around_;
    double reach_ = 0;
    std::optional<GroundPlane> ground_;
    bool whole_ = false; ///< the object reached fits into the picture's reach
    Rerooted result_;
};

} // namespace

std::optional<Rerooted> reroot(const ZoomModel& model, const ZoomRequest& request,
                               const FrameObject& frame_object, const std::optional<Vec3>& look_at,
                               Diagnostics& diagnostics, const Control& control) {
    return Rerooter(model, request, frame_object, diagnostics, control).run(look_at);
}

} // namespace graftal
