#pragma once

// Intersections with the items of runs; only traversal.cpp includes this.

#include <glm/geometric.hpp>

#include "compiler/primitives/texture_space.h"
#include "runtime/trace/traverse/kernel.h"

namespace graftal {

template<Instructions instructions, bool any>
void Traversal::Kernel<instructions, any>::meet_item(const Entry& entry) {
    depth = entry.frame + 1;
    const Frame& frame = frames[entry.frame];
    const TraceRun& run = model.runs[model.nodes[frame.node].run];
    const RunItem& item = (*run.run)[entry.entry];
    const Affine& run_from_frame = model.graph_from_frame[frame.node];
    const Ray ray{run_from_frame(vec3_of(frame.origin + splat(entry.at) * frame.direction)),
                  run_from_frame.linear * vec3_of(frame.direction)};
    const Vec3 from_base = ray.origin - item.base;
    if (item.shape.is_sphere() || !passes_line(ray.direction, from_base, item.axis, item.radius))
        meet_body(item.shape, run.pictured ? run_from_body(item) : run_from_round_body(item), run,
                  item.colour, ray, entry);
    if (item.ball && !passes_point(ray.direction, from_base - item.axis, item.radius))
        meet_body(PrimitiveKind::sphere, run.pictured ? run_from_ball(item) : run_from_round_ball(item), run,
                  item.colour, ray, entry);
}

template<Instructions instructions, bool any>
void Traversal::Kernel<instructions, any>::meet_body(RunShape shape, const Affine& run_from_body,
                                                     const TraceRun& run, std::uint16_t colour,
                                                     const Ray& ray, const Entry& entry) {
    const Frame& frame = frames[entry.frame];
    // The axes are at right angles: dividing by the squares of their lengths turns the map round.
    const Mat3& m = run_from_body.linear;
    const Vec3 squares(glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2]));
    const Vec3 direction = ray.direction * m / squares;
    const double largest = largest_component(lanes_of(direction));
    if (!(largest > 0 && largest < 1 / least_scale)) return;
    const Ray inner{(ray.origin - run_from_body.translation) * m / squares, direction / largest};
    const double base = t_of(entry), speed = frame.speed * largest;
    RayRange near = range_from(base, speed);
    PrimitiveHit hit;
    const Primitive primitive = shape.primitive();
    if (!self.meet_asked(primitive, inner, near, hit)) return;
    std::uint32_t look = no_edge;
    double turns = 1;
    if (model.clear_texels && !self.searches_solids()) {
        look = run.edge_of(shape, colour);
        turns = length_in_turns(run_from_body.linear);
        for (int crossing = 0; self.is_clear(look, entry.frame, turns, inner(hit.t)); ++crossing) {
            near.least = hit.t;
            if (crossing == most_crossings || !intersect(primitive, inner, near, hit)) return;
        }
    }
    if (!set_best(base + hit.t / speed)) return;
    if (look == no_edge) {
        look = run.edge_of(shape, colour);
        turns = length_in_turns(run_from_body.linear);
    }
    self.best_.normal = hit.normal;
    self.best_.point = inner(hit.t);
    self.best_.turns = turns;
    self.best_.proxy_node = no_edge;
    compose(frame.world_from_node, LaneMap(inverse(model.graph_from_frame[frame.node]) * run_from_body),
            self.best_.world_from_leaf);
    self.keep_way(entry.frame);
    self.way_.push_back(look);
}

} // namespace graftal
