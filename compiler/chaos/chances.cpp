#include "compiler/chaos/chances.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "compiler/analysis/cycle_graph.h"
#include "compiler/chaos/surface.h"

namespace graftal {

namespace {

constexpr double share_of_flattening = 0.01;
constexpr double flattening = 0.02; ///< area_factor / norm^2 below which a map counts as flattening
constexpr double most_kept = 0.95;  ///< area from level to level where levels are drawn
constexpr std::uint64_t most_work = 400'000'000; ///< visits of edges, for one component

/// A cyclic component and the sizes of its edges.
struct SizedCycle {
    const CycleGraph& cycle;
    std::vector<double> log_size; ///< by edge

    double factor(std::size_t edge, double exponent) const { return std::exp(exponent * log_size[edge]); }
};

SizedCycle sized(const CycleGraph& cycle) {
    SizedCycle result{cycle, {}};
    double largest = 0;
    for (const CycleEdge& edge : cycle.edges)
        largest = std::max(largest, area_factor(cycle.transform(edge).linear));
    if (!(largest > 0)) largest = 1;
    for (const CycleEdge& edge : cycle.edges) {
        const Mat3& linear = cycle.transform(edge).linear;
        double size = area_factor(linear);
        const double stretch = norm(linear);
        if (size < flattening * stretch * stretch) size = std::max(size, share_of_flattening * largest);
        result.log_size.push_back(std::log(std::max(size, 1e-300)));
    }
    return result;
}

/// x = b + C x with C the factors, to the power of `exponent`. With b = 0 and `growth`: one round of
/// x -> (I + C) x, scaled to 1; the growth of I + C, less 1.
class Masses {
  public:
    Masses(const SizedCycle& cycle, std::uint64_t& work) : cycle_(cycle), work_(work) {}

    /// The spectral radius of C, by iteration of I + C (which cannot swing); leaves its vector in `masses`.
    double radius(double exponent, std::vector<double>& masses) {
        masses.assign(cycle_.cycle.size(), 1.0);
        std::vector<double> next;
        double growth = 0;
        for (int round = 0; round < 20'000 && spend(); ++round) {
            next = masses;
            add(exponent, masses, next);
            const double before = growth;
            growth = *std::max_element(next.begin(), next.end());
            double least = growth;
            for (std::size_t v = 0; v < next.size(); ++v) {
                if (masses[v] > 0) least = std::min(least, next[v] / masses[v]);
                masses[v] = next[v] / growth;
            }
            if (std::abs(growth - before) < 1e-13 * growth && growth - least < 1e-12 * growth) break;
        }
        return growth - 1;
    }

    std::vector<double> solve(double exponent, const std::vector<double>& begins) {
        std::vector<double> masses = begins, next;
        for (int round = 0; round < 20'000 && spend(); ++round) {
            next = begins;
            add(exponent, masses, next);
            double change = 0, largest = 0;
            for (std::size_t v = 0; v < next.size(); ++v) {
                change = std::max(change, std::abs(next[v] - masses[v]));
                largest = std::max(largest, next[v]);
            }
            masses.swap(next);
            if (change < 1e-14 * largest) break;
        }
        return masses;
    }

    /// The exponent at which the radius is `wanted`, at least `from`, where it is more.
    double exponent_of(double wanted, double from, std::vector<double>& masses) {
        double low = from, high = std::max(2 * from, 1.0);
        while (radius(high, masses) > wanted && high < 1e6)
            low = high, high *= 2;
        for (int halving = 0; halving < 60 && high - low > 1e-15 * high; ++halving) {
            const double middle = 0.5 * (low + high);
            (radius(middle, masses) > wanted ? low : high) = middle;
        }
        radius(high, masses);
        return high;
    }

  private:
    void add(double exponent, const std::vector<double>& x, std::vector<double>& sum) {
        if (exponent != exponent_) {
            factors_.clear();
            for (std::size_t e = 0; e < cycle_.log_size.size(); ++e)
                factors_.push_back(cycle_.factor(e, exponent));
            exponent_ = exponent;
        }
        for (std::size_t e = 0; e < factors_.size(); ++e)
            sum[cycle_.cycle.edges[e].from] += factors_[e] * x[cycle_.cycle.edges[e].to];
    }

    bool spend() {
        const std::uint64_t cost = cycle_.log_size.size() + 1;
        if (work_ < cost) return false;
        work_ -= cost;
        return true;
    }

    const SizedCycle& cycle_;
    std::uint64_t& work_;
    double exponent_ = -1;
    std::vector<double> factors_;
};

class ChanceFinder {
  public:
    ChanceFinder(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds)
        : graph_(graph), components_(components), bounds_(bounds), mass_(graph.objects.size(), 0.0) {
        for (const Object& object : graph.objects)
            chances_.emplace_back(object.instances.size(), 0.0);
    }

    Chances chances() && {
        find();
        return std::move(chances_);
    }
    std::vector<double> sizes() && {
        find();
        return std::move(mass_);
    }

  private:
    void find() {
        const std::vector<std::uint32_t> places = places_in_components(components_);
        for (std::uint32_t c = 0; c < components_.members.size(); ++c) {
            if (components_.cyclic[c])
                find_cycle(cycle_graph(graph_, components_, places, c), places);
            else
                find_single(components_.members[c].front());
        }
    }

    bool stated(ObjectId id) const {
        const std::vector<Instance>& instances = graph_.objects[id].instances;
        return std::any_of(instances.begin(), instances.end(),
                           [](const Instance& instance) { return instance.chance > 0; });
    }

    /// Requires that the master is done.
    double size_of(const Instance& instance) const {
        return placed_size(graph_, instance.master, instance.parent_from_child, mass_);
    }

    /// The chances of one object, from what each instance has.
    void settle(ObjectId id, const std::vector<double>& sizes) {
        const std::vector<Instance>& instances = graph_.objects[id].instances;
        const bool by_statement = stated(id);
        const auto part = [&](std::size_t i) {
            if (!by_statement) return sizes[i];
            return empty(instances[i].master) ? 0 : instances[i].chance;
        };
        double sum = 0;
        for (std::size_t i = 0; i < instances.size(); ++i)
            sum += part(i);
        if (!(sum > 0) || !std::isfinite(sum)) return;
        for (std::size_t i = 0; i < instances.size(); ++i)
            chances_[id][i] = part(i) / sum;
    }

    bool empty(ObjectId id) const {
        return graph_.objects[id].primitive ? graph_.objects[id].primitive == PrimitiveKind::plane
                                            : !components_.unending[id] && mass_[id] == 0;
    }

    void find_single(ObjectId id) {
        std::vector<double> sizes;
        for (const Instance& instance : graph_.objects[id].instances)
            sizes.push_back(size_of(instance));
        for (const double size : sizes)
            mass_[id] += size;
        for (const double area : areas_of_items(graph_.objects[id].packed))
            mass_[id] += area;
        settle(id, sizes);
    }

    void find_cycle(const CycleGraph& cycle, const std::vector<std::uint32_t>& places) {
        std::vector<double> begins(cycle.size(), 0.0);
        std::vector<std::vector<double>> sizes(cycle.size());
        bool draws = false, any_stated = false;
        for (std::uint32_t v = 0; v < cycle.size(); ++v) {
            any_stated |= stated(cycle.objects[v]);
            for (const Instance& instance : graph_.objects[cycle.objects[v]].instances) {
                const bool inside =
                    components_.component_of[instance.master] == components_.component_of[cycle.objects[v]];
                sizes[v].push_back(inside ? 0 : size_of(instance));
                begins[v] += sizes[v].back();
            }
            draws |= begins[v] > 0;
        }
        std::uint64_t work = most_work;
        const SizedCycle factors = sized(cycle);
        Masses masses(factors, work);
        std::vector<double> mass;
        double exponent = 1;
        if (draws) {
            if (masses.radius(1, mass) > most_kept) exponent = masses.exponent_of(most_kept, 1, mass);
            mass = masses.solve(exponent, begins);
        } else {
            exponent = masses.exponent_of(1, 0, mass);
        }
        for (std::size_t e = 0; e < cycle.edges.size(); ++e) {
            const CycleEdge& edge = cycle.edges[e];
            sizes[places[edge.step.object]][edge.step.instance] = factors.factor(e, exponent) * mass[edge.to];
        }
        for (std::uint32_t v = 0; v < cycle.size(); ++v)
            settle(cycle.objects[v], sizes[v]);
        note_masses(cycle, mass, draws && !any_stated);
    }

    /// A limit set without area counts as much as the ball around it, beside what has some.
    void note_masses(const CycleGraph& cycle, const std::vector<double>& mass, bool area) {
        double largest = 0, disc = 0;
        for (std::uint32_t v = 0; v < cycle.size(); ++v) {
            const double radius = std::max(bounds_[cycle.objects[v]].ball.radius, 0.0);
            largest = std::max(largest, mass[v]);
            disc = std::max(disc, std::numbers::pi * radius * radius);
        }
        for (std::uint32_t v = 0; v < cycle.size(); ++v)
            mass_[cycle.objects[v]] = area || !(largest > 0) ? mass[v] : mass[v] / largest * disc;
    }

    const Graph& graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    std::vector<double> mass_; ///< by object, in units of area
    Chances chances_;
};

} // namespace

double area_factor(const Mat3& linear) {
    const double largest = largest_entry(linear);
    if (!(largest > 0)) return 0;
    return largest * largest * std::pow(std::abs(glm::determinant(linear / largest)), 2.0 / 3.0);
}

Chances chances_of(const Graph& graph, const Components& components,
                   const std::vector<ObjectBounds>& bounds) {
    return ChanceFinder(graph, components, bounds).chances();
}

std::vector<double> sizes_of(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds) {
    return ChanceFinder(graph, components, bounds).sizes();
}

double placed_size(const Graph& graph, ObjectId part, const Affine& map, const std::vector<double>& sizes) {
    const std::optional<Primitive>& primitive = graph.objects[part].primitive;
    if (primitive) return *primitive == PrimitiveKind::plane ? 0 : PlacedSurface(*primitive, map).area();
    // A part that is flattened for good has an area all the same.
    const double stretch = norm(map.linear);
    return std::max(area_factor(map.linear), flattening * stretch * stretch) * sizes[part];
}

} // namespace graftal
