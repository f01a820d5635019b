#include "compiler/chaos/ordinary_ifs.h"

#include <algorithm>
#include <cmath>

#include "compiler/analysis/contraction.h"

namespace graftal {

namespace {

bool same_placement(const Instance& a, const Instance& b) {
    return a.master == b.master && a.parent_from_child == b.parent_from_child;
}

class Recogniser {
  public:
    Recogniser(const Graph& graph, const Components& components) : graph_(graph), components_(components) {}

    std::optional<OrdinaryIfs> recognise() const {
        const Object& root = graph_.objects[graph_.root];
        if (components_.cyclic[components_.component_of[graph_.root]]) return recursion(graph_.root, {});
        std::vector<Instance> inner, ending;
        split(root, inner, ending);
        for (const Instance& instance : inner)
            if (!(instance.parent_from_child == Affine())) return std::nullopt;
        if (inner.size() == 1 && is_alone(inner.front().master) &&
            !splits_like_root(inner.front().master, inner, ending))
            return ending.empty() ? recursion(inner.front().master, {}) : std::nullopt;
        return union_of(inner, ending);
    }

  private:
    void split(const Object& object, std::vector<Instance>& inner, std::vector<Instance>& ending) const {
        for (const Instance& instance : object.instances)
            (components_.unending[instance.master] ? inner : ending).push_back(instance);
    }

    bool is_alone(ObjectId id) const { return components_.members[components_.component_of[id]].size() == 1; }

    /// One object that contains itself and what ends.
    std::optional<OrdinaryIfs> recursion(ObjectId id, OrdinaryIfs ifs) const {
        if (!is_alone(id)) return std::nullopt;
        split(graph_.objects[id], ifs.maps, ifs.condensation);
        for (const Instance& map : ifs.maps)
            if (map.master != id) return std::nullopt;
        return ifs;
    }

    bool splits_like_root(ObjectId id, const std::vector<Instance>& inner,
                          const std::vector<Instance>& ending) const {
        return part(id, inner, ending).has_value();
    }

    /// The map w of an object that is w(root): the same masters as the root has, all under w.
    std::optional<Instance> part(ObjectId id, const std::vector<Instance>& inner,
                                 const std::vector<Instance>& ending) const {
        std::vector<Instance> masters, parts;
        split(graph_.objects[id], masters, parts);
        if (masters.size() != inner.size() || parts.size() != ending.size()) return std::nullopt;
        const Affine& map = masters.front().parent_from_child;
        const auto by_master = [](const Instance& a, const Instance& b) { return a.master < b.master; };
        std::sort(masters.begin(), masters.end(), by_master);
        for (std::size_t i = 0; i < inner.size(); ++i)
            if (masters[i].master != inner[i].master || !(masters[i].parent_from_child == map))
                return std::nullopt;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            Instance expected = ending[i];
            expected.parent_from_child = map * expected.parent_from_child;
            if (!same_placement(parts[i], expected)) return std::nullopt;
        }
        return masters.front();
    }

    /// Every part of the root is the root itself under a map.
    std::optional<OrdinaryIfs> union_of(std::vector<Instance> inner,
                                        const std::vector<Instance>& ending) const {
        std::sort(inner.begin(), inner.end(),
                  [](const Instance& a, const Instance& b) { return a.master < b.master; });
        OrdinaryIfs ifs;
        ifs.condensation = ending;
        for (const Instance& instance : inner) {
            const std::optional<Instance> map = part(instance.master, inner, ending);
            if (!map) return std::nullopt;
            ifs.maps.push_back(*map);
        }
        return ifs;
    }

    const Graph& graph_;
    const Components& components_;
};

/// The part of a map in the plane, as a matrix of space that leaves z alone out.
Mat3 flat_part(const Mat3& m) {
    return {m[0][0], m[0][1], 0, m[1][0], m[1][1], 0, 0, 0, 0};
}

/// An object that contains itself under all the maps.
Graph one_object(const std::vector<Instance>& maps) {
    Graph graph;
    Object object;
    object.name = "a";
    for (const Instance& map : maps) {
        Instance instance;
        instance.parent_from_child.linear = flat_part(map.parent_from_child.linear);
        object.instances.push_back(instance);
    }
    graph.add(std::move(object));
    return graph;
}

double rate_in(const Mat3& metric, const std::vector<Instance>& maps) {
    const Affine to_metric{metric, Vec3(0.0)};
    const Affine back = inverse(to_metric);
    double rate = 0;
    for (const Instance& map : maps)
        rate = std::max(rate, norm(metric * flat_part(map.parent_from_child.linear) * back.linear));
    return rate;
}

/// The metric that a certificate has for vectors of the plane: the upper left 2 x 2 of L, which is
/// triangular.
PlaneNorm norm_of_certificate(const Mat3& metric, const std::vector<Instance>& maps) {
    PlaneNorm result;
    result.metric = flat_part(metric);
    result.metric[2][2] = std::max(result.metric[0][0], result.metric[1][1]);
    result.rate = rate_in(result.metric, maps);
    const Vec3 values = singular_values(flat_part(metric));
    result.condition = values.x / values.y;
    return result;
}

} // namespace

std::optional<OrdinaryIfs> ordinary_ifs(const Graph& graph, const Components& components) {
    if (!components.unending[graph.root]) return std::nullopt;
    return Recogniser(graph, components).recognise();
}

PlaneNorm contracting_norm(const std::vector<Instance>& maps) {
    PlaneNorm plain;
    plain.rate = rate_in(Mat3(1.0), maps);
    if (plain.rate < 1) return plain;
    const Graph graph = one_object(maps);
    const Contraction contraction = decide_contraction(graph, strong_components(graph));
    if (contraction.verdict != Verdict::proved || contraction.certificate.metric.empty()) return plain;
    const PlaneNorm found = norm_of_certificate(contraction.certificate.metric.front(), maps);
    return found.rate < 1 ? found : plain;
}

bool is_flat(const Affine& map) {
    const double slack = 1e-12 * (largest_entry(map.linear) + largest_entry(map.translation));
    return std::abs(map.linear[0][2]) <= slack && std::abs(map.linear[1][2]) <= slack &&
           std::abs(map.translation.z) <= slack;
}

} // namespace graftal
