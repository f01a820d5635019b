#include "compiler/analysis/invariant.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace graftal {

namespace {

constexpr std::uint64_t edge_visits_per_stage = 2'000'000;

int sweeps_for(const CycleGraph& cycle, int most) {
    const std::uint64_t affordable = edge_visits_per_stage / std::max<std::size_t>(cycle.edges.size(), 1);
    return static_cast<int>(std::clamp<std::uint64_t>(affordable, 8, static_cast<std::uint64_t>(most)));
}

class Invariant {
  public:
    Invariant(const CycleGraph& cycle, const Components& components,
              const ContractionCertificate& certificate, Outers& outers)
        : cycle_(cycle), components_(components), certificate_(certificate), outers_(outers),
          component_(components.component_of[cycle.objects.front()]), radius_(cycle.size(), 0.0) {}

    void run() {
        find_points();
        find_centres();
        find_radii();
        shrink_radii();
        for (std::uint32_t v = 0; v < cycle_.size(); ++v)
            finish(v);
        shrink_boxes();
    }

  private:
    const Mat3& metric(ObjectId id) const { return certificate_.metric[id]; }
    bool inside(ObjectId id) const { return components_.component_of[id] == component_; }

    /// A point of each limit set: every object follows its first edge; what that leads to is a cycle with a
    /// fixed point, found by going round it until nothing changes.
    void find_points() {
        const std::uint32_t n = cycle_.size();
        std::vector<std::uint32_t> state(n, 0); // 0: new, else the number of the walk, or done
        constexpr std::uint32_t done = UINT32_MAX;
        for (std::uint32_t start = 0; start < n; ++start) {
            std::vector<std::uint32_t> walk;
            std::uint32_t v = start;
            while (state[v] == 0) {
                state[v] = start + 1;
                walk.push_back(v);
                v = edge(v).to;
            }
            if (state[v] == start + 1) go_round(v);
            for (std::size_t i = walk.size(); i-- > 0;) {
                state[walk[i]] = done;
                step_back(walk[i]);
            }
        }
    }

    const CycleEdge& edge(std::uint32_t v) const { return cycle_.edges[cycle_.first[v]]; }

    void step_back(std::uint32_t v) {
        Outer& outer = outers_[cycle_.objects[v]];
        outer.points[0] = cycle_.transform(edge(v))(outers_[cycle_.objects[edge(v).to]].points[0]);
        outer.point_count = 1;
    }

    void go_round(std::uint32_t start) {
        std::vector<std::uint32_t> ring;
        std::uint32_t v = start;
        do {
            ring.push_back(v);
            v = edge(v).to;
        } while (v != start);
        // The map once around is composed with itself until it is constant: its translation is the point.
        Affine around;
        for (const std::uint32_t w : ring)
            around = around * cycle_.transform(edge(w));
        for (int doubling = 0; doubling < 64 && is_finite(around); ++doubling)
            around = around * around;
        Outer& outer = outers_[cycle_.objects[start]];
        outer.points[0] = around.translation;
        for (int i = 0; i < 3; ++i)
            outer.points[0][i] = within_range(outer.points[0][i]);
        outer.point_count = 1;
        for (std::size_t i = ring.size(); i-- > 1;)
            step_back(ring[i]);
    }

    /// Any centres do; means of the centres of the parts make the radii small.
    void find_centres() {
        for (const ObjectId id : cycle_.objects)
            outers_[id].centre = outers_[id].points[0];
        const int sweeps = sweeps_for(cycle_, 60);
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            for (const ObjectId id : cycle_.objects) {
                Vec3 sum(0.0);
                double count = 0;
                for (const Instance& instance : cycle_.graph->objects[id].instances) {
                    const Outer& outer = outers_[instance.master];
                    if (outer.empty && !inside(instance.master)) continue;
                    sum += instance.parent_from_child(outer.centre);
                    ++count;
                }
                for (int i = 0; i < 3; ++i)
                    outers_[id].centre[i] = within_range(sum[i] / count);
            }
        }
    }

    /// The distance of a placed point from the centre of `v`, in its metric, with room for its rounding.
    double distance(ObjectId v, const Affine& place, Vec3 point) const {
        const Mat3& l = metric(v);
        const Vec3 moved = place.linear * point;
        const double size =
            glm::length(moved) + glm::length(place.translation) + glm::length(outers_[v].centre);
        return glm::length(l * (moved + place.translation - outers_[v].centre)) + 4e-15 * norm(l) * size;
    }

    /// Farthest distance from the centre of `v`, in its metric, that an instance at `place` reaches.
    double reach_of_outside(ObjectId v, const Affine& place, const Outer& part) const {
        return distance(v, place, part.centre) + norm(metric(v) * place.linear * glm::transpose(part.reach));
    }

    /// A radius in units of the weights that holds for all objects: no path that the certificate follows, nor
    /// anything that leaves the component on the way, ends farther out.
    void find_radii() {
        const double log_unit = middle_log_weight();
        double common = 0;
        for (std::uint32_t v = 0; v < cycle_.size(); ++v) {
            const double unit = std::exp(certificate_.log_weight[cycle_.objects[v]] - log_unit);
            common = std::max(common, within_range(walk_from(v) / unit));
        }
        for (std::uint32_t v = 0; v < cycle_.size(); ++v)
            radius_[v] =
                within_range(common * std::exp(certificate_.log_weight[cycle_.objects[v]] - log_unit));
    }

    double middle_log_weight() const {
        double least = INFINITY, most = -INFINITY;
        for (const ObjectId id : cycle_.objects) {
            least = std::min(least, certificate_.log_weight[id]);
            most = std::max(most, certificate_.log_weight[id]);
        }
        return 0.5 * (least + most);
    }

    struct Step {
        ObjectId object;
        std::size_t next_instance;
        Affine place;
    };

    /// The radius that object v needs, its own unit being 1: r >= distance + rate^length r for each prefix
    /// that the certificate names.
    double walk_from(std::uint32_t v) const {
        const ObjectId start = cycle_.objects[v];
        double needed = 0;
        std::vector<Step> path{{start, 0, Affine{}}};
        while (!path.empty()) {
            Step& step = path.back();
            const std::vector<Instance>& instances = cycle_.graph->objects[step.object].instances;
            if (step.next_instance == instances.size()) {
                path.pop_back();
                continue;
            }
            const Instance& instance = instances[step.next_instance++];
            const Affine place = step.place * instance.parent_from_child;
            if (!inside(instance.master)) {
                const Outer& part = outers_[instance.master];
                if (!part.empty)
                    needed = std::max(needed, within_range(reach_of_outside(start, place, part)));
                continue;
            }
            const double shrunk = std::pow(certificate_.rate, static_cast<double>(path.size()));
            if (path.size() < static_cast<std::size_t>(certificate_.depth) &&
                !shrinks(start, instance.master, place, shrunk)) {
                path.push_back({instance.master, 0, place});
                continue;
            }
            const double shift = distance(start, place, outers_[instance.master].centre);
            needed = std::max(needed, within_range(shift / (1 - shrunk)));
        }
        return needed;
    }

    bool shrinks(ObjectId v, ObjectId u, const Affine& place, double shrunk) const {
        const double stretch = norm(metric(v) * place.linear * glm::inverse(metric(u)));
        return stretch * std::exp(certificate_.log_weight[u] - certificate_.log_weight[v]) <= shrunk;
    }

    /// True radii stay true when each is replaced by what its instances reach.
    void shrink_radii() {
        std::vector<double> stretch, shift;
        for (const CycleEdge& e : cycle_.edges) {
            const Affine& place = cycle_.transform(e);
            const ObjectId v = cycle_.objects[e.from], u = cycle_.objects[e.to];
            stretch.push_back(norm(metric(v) * place.linear * glm::inverse(metric(u))));
            shift.push_back(distance(v, place, outers_[u].centre));
        }
        std::vector<double> outside(cycle_.size(), 0.0);
        for (std::uint32_t v = 0; v < cycle_.size(); ++v)
            for (const Instance& instance : cycle_.graph->objects[cycle_.objects[v]].instances)
                if (!inside(instance.master) && !outers_[instance.master].empty)
                    outside[v] =
                        std::max(outside[v], reach_of_outside(cycle_.objects[v], instance.parent_from_child,
                                                              outers_[instance.master]));
        const int sweeps = sweeps_for(cycle_, 100);
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            for (std::uint32_t v = 0; v < cycle_.size(); ++v) {
                double needed = outside[v];
                for (std::uint32_t e = cycle_.first[v]; e < cycle_.first[v + 1]; ++e)
                    needed = std::max(needed, shift[e] + stretch[e] * radius_[cycle_.edges[e].to]);
                if (needed < radius_[v]) radius_[v] = needed;
            }
        }
    }

    void finish(std::uint32_t v) {
        const ObjectId id = cycle_.objects[v];
        Outer& outer = outers_[id];
        // Room for rounding, here and in the radii.
        const double radius = radius_[v] * (1 + 1e-9) + 1e-14 * glm::length(metric(id) * outer.centre);
        outer.reach = radius * glm::transpose(glm::inverse(metric(id)));
        Vec3 half(0.0);
        for (int i = 0; i < 3; ++i)
            half[i] = glm::length(outer.reach[i]);
        outer.box = {outer.centre - half, outer.centre + half};
        outer.empty = false;
    }

    /// True boxes stay true when each is replaced by what its instances reach. Where maps take axes to axes,
    /// as that across a flat figure, this alone finds the face: products of unequal scales, all of which
    /// reach as far there, would keep a best-first search busy for ever.
    void shrink_boxes() {
        std::size_t instances = 0;
        for (const ObjectId id : cycle_.objects)
            instances += cycle_.graph->objects[id].instances.size();
        std::uint64_t visits_left = 4 * edge_visits_per_stage;
        for (bool moved = true; moved && visits_left >= 6 * instances;) {
            visits_left -= 6 * instances;
            moved = false;
            for (const ObjectId id : cycle_.objects)
                moved = shrink_box(id) || moved;
        }
    }

    bool shrink_box(ObjectId id) {
        constexpr double worth_a_sweep = 1e-14; // of the size
        Box& box = outers_[id].box;
        const double least = worth_a_sweep * glm::length(box.max - box.min);
        bool moved = false;
        for (int axis = 0; axis < 3; ++axis) {
            const double above = face(id, axis, 1), below = -face(id, axis, -1);
            moved = moved || box.max[axis] - above > least || below - box.min[axis] > least;
            box.max[axis] = std::min(box.max[axis], above);
            box.min[axis] = std::max(box.min[axis], below);
        }
        return moved;
    }

    /// Reach of the instances along an axis, or against it.
    double face(ObjectId id, int axis, double sign) const {
        constexpr double rounding = 2e-15; // of the terms of a sum, for a dozen operations
        double most = -INFINITY;
        for (const Instance& instance : cycle_.graph->objects[id].instances) {
            const Outer& part = outers_[instance.master];
            if (part.empty) continue;
            const Affine& place = instance.parent_from_child;
            const Vec3 direction =
                sign * Vec3(place.linear[0][axis], place.linear[1][axis], place.linear[2][axis]);
            const double shift = sign * place.translation[axis];
            double terms = std::abs(shift);
            for (int i = 0; i < 3; ++i)
                terms +=
                    std::abs(direction[i]) * std::max(std::abs(part.box.min[i]), std::abs(part.box.max[i]));
            const double reach = shift + part.above(direction) + rounding * terms;
            if (!(std::abs(reach) < largest_length)) return largest_length;
            most = std::max(most, reach);
        }
        return most;
    }

    const CycleGraph& cycle_;
    const Components& components_;
    const ContractionCertificate& certificate_;
    Outers& outers_;
    std::uint32_t component_;
    std::vector<double> radius_; // by local object, in its metric
};

} // namespace

void bound_cycle(const CycleGraph& cycle, const Components& components,
                 const ContractionCertificate& certificate, Outers& outers) {
    Invariant(cycle, components, certificate, outers).run();
}

} // namespace graftal
