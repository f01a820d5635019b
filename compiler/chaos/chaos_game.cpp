#include "compiler/chaos/chaos_game.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "compiler/graph/markov.h"

namespace graftal {

namespace {

/// The graph without the instances that are never taken; the chances stand in the instances.
Graph walked_graph(const Graph& graph, const Chances& chances) {
    Graph walked;
    walked.root = graph.root;
    walked.materials = graph.materials;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        Object object;
        object.primitive = graph.objects[id].primitive;
        object.packed = graph.objects[id].packed;
        for (std::size_t i = 0; i < chances[id].size(); ++i) {
            if (!(chances[id][i] > 0)) continue;
            object.instances.push_back(graph.objects[id].instances[i]);
            object.instances.back().chance = chances[id][i];
        }
        walked.objects.push_back(std::move(object));
    }
    return walked;
}

bool before(const Affine& a, const Affine& b) {
    const auto numbers = [](const Affine& m) {
        std::array<double, 12> all;
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r)
                all[static_cast<std::size_t>(3 * c + r)] = m.linear[c][r];
            all[static_cast<std::size_t>(9 + c)] = m.translation[c];
        }
        return all;
    };
    return numbers(a) < numbers(b);
}

std::uint32_t moves_to_settle(double rate) {
    constexpr double forgotten = 1e-14;
    if (!(rate > 0 && rate < 1)) return 64;
    return static_cast<std::uint32_t>(std::clamp(2 * std::log(forgotten) / std::log(rate), 64.0, 100'000.0));
}

} // namespace

class ChaosGame::Builder {
  public:
    Builder(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
            double rate)
        : graph_(walked_graph(graph, chances_of(graph, components, bounds))),
          components_(strong_components(graph_)), begins_(graph.objects.size(), 0.0),
          arrivals_(graph.objects.size()), bounds_(bounds) {
        game_.settling_ = moves_to_settle(rate);
        for (const Material& material : graph_.materials)
            game_.materials_.push_back(material.rgb);
    }

    std::optional<ChaosGame> build() && {
        const Object& root = graph_.objects[graph_.root];
        if (root.instances.empty() && !root.packed) return std::nullopt;
        game_.states_.resize(graph_.objects.size());
        begins_[graph_.root] = 1;
        for (std::size_t c = components_.members.size(); c-- > 0;) // users before their masters
            add_component(static_cast<std::uint32_t>(c));
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            add_climb(id);
        if (game_.sources_.empty()) return std::nullopt;
        for (std::size_t c = 0; c < game_.cores_.size(); ++c)
            game_.cores_[c].in_world = game_.cores_[c].always_leaves && is_in_world(c);
        game_.source_choice_ = game_.tables_.add(source_weights_);
        return std::move(game_);
    }

  private:
    /// An instance by which walks go down, and how many do.
    struct Arrival {
        ObjectId user;
        std::uint32_t instance;
        double visits;
    };

    void add_component(std::uint32_t c) {
        const std::vector<ObjectId>& members = components_.members[c];
        const bool reached =
            std::any_of(members.begin(), members.end(), [&](ObjectId id) { return begins_[id] > 0; });
        if (!reached || graph_.objects[members.front()].primitive) return;
        if (components_.cyclic[c] && closed(c)) return add_core(c);
        std::vector<double> visits;
        for (const ObjectId id : members)
            visits.push_back(begins_[id]);
        if (components_.cyclic[c]) {
            const std::vector<double> begins = visits;
            visits = expected_visits(visits, steps_inside(c));
            if (!leaves_in_time(begins, visits)) {
                drop_ways_out(c);
                return add_core(c);
            }
        }
        for (std::size_t i = 0; i < members.size(); ++i)
            pass_on(members[i], visits[i]);
    }

    bool closed(std::uint32_t c) const {
        for (const ObjectId id : components_.members[c])
            for (const Instance& instance : graph_.objects[id].instances)
                if (components_.component_of[instance.master] != c) return false;
        return true;
    }

    /// False where the ways out are taken so rarely that no random number stands for them (AliasTables).
    static bool leaves_in_time(const std::vector<double>& begins, const std::vector<double>& visits) {
        constexpr double most_rounds = 1e9;
        double all_begins = 0;
        for (const double begin : begins)
            all_begins += begin;
        return std::ranges::all_of(visits, [&](double visit) { return visit <= most_rounds * all_begins; });
    }

    void drop_ways_out(std::uint32_t c) {
        for (const ObjectId id : components_.members[c]) {
            std::vector<Instance>& instances = graph_.objects[id].instances;
            std::erase_if(instances, [&](const Instance& instance) {
                return components_.component_of[instance.master] != c;
            });
            double stays = 0;
            for (const Instance& instance : instances)
                stays += instance.chance;
            for (Instance& instance : instances)
                instance.chance /= stays;
        }
    }

    std::vector<WalkStep> steps_inside(std::uint32_t c) {
        const std::vector<ObjectId>& members = components_.members[c];
        places_.resize(graph_.objects.size());
        for (std::uint32_t i = 0; i < members.size(); ++i)
            places_[members[i]] = i;
        std::vector<WalkStep> steps;
        for (std::uint32_t i = 0; i < members.size(); ++i)
            for (const Instance& instance : graph_.objects[members[i]].instances)
                if (components_.component_of[instance.master] == c)
                    steps.push_back({i, places_[instance.master], instance.chance});
        return steps;
    }

    void pass_on(ObjectId id, double visits) {
        const Object& object = graph_.objects[id];
        if (object.packed && visits > 0) add_packed(id, visits);
        for (std::uint32_t i = 0; i < object.instances.size(); ++i) {
            const Instance& instance = object.instances[i];
            const double flow = visits * instance.chance;
            if (!(flow > 0)) continue;
            if (graph_.objects[instance.master].primitive) {
                add_surface(id, instance, flow);
                continue;
            }
            // Flow from inside the component is among the visits already.
            if (components_.component_of[instance.master] != components_.component_of[id])
                begins_[instance.master] += flow;
            arrivals_[instance.master].push_back({id, i, flow});
        }
    }

    void add_surface(ObjectId id, const Instance& instance, double flow) {
        Source source;
        source.state = id;
        source.surface.emplace(*graph_.objects[instance.master].primitive, instance.parent_from_child);
        source.paint = Paint(PathTint(instance.tint));
        source.material = instance.material.value_or(none);
        game_.sources_.push_back(std::move(source));
        source_weights_.push_back(flow);
    }

    void add_packed(ObjectId id, double flow) {
        Source source;
        source.state = id;
        source.packed = graph_.objects[id].packed;
        source.items = game_.tables_.add(areas_of_items(source.packed));
        game_.sources_.push_back(std::move(source));
        source_weights_.push_back(flow);
    }

    void add_core(std::uint32_t c) {
        const std::vector<ObjectId>& members = components_.members[c];
        const std::vector<double> shares =
            stationary_shares(static_cast<std::uint32_t>(members.size()), steps_inside(c));
        Core core;
        core.base = mean_material(c, shares);
        core.start = game_.tables_.add(shares, static_cast<std::uint32_t>(game_.entries_.size()));
        game_.entries_.insert(game_.entries_.end(), members.begin(), members.end());
        game_.middles_.resize(graph_.objects.size());

        double entering = 0, most = 0, least = 1e300;
        for (std::size_t i = 0; i < members.size(); ++i) {
            const double ratio = begins_[members[i]] / shares[i];
            entering += begins_[members[i]];
            most = std::max(most, ratio);
            least = std::min(least, ratio);
        }
        core.always_leaves = least > (1 - 1e-9) * most;
        for (std::size_t i = 0; i < members.size(); ++i) {
            game_.states_[members[i]].leave = begins_[members[i]] / shares[i] / most;
            game_.middles_[members[i]] = bounds_[members[i]].ball.centre;
        }
        add_wandering(c, shares);
        Source source;
        source.core = static_cast<std::uint32_t>(game_.cores_.size());
        game_.sources_.push_back(std::move(source));
        source_weights_.push_back(entering);
        game_.cores_.push_back(std::move(core));
        first_of_core_.push_back(members.front());
    }

    void add_wandering(std::uint32_t c, const std::vector<double>& shares) {
        const std::vector<ObjectId>& members = components_.members[c];
        std::vector<std::vector<Arrival>> inside(members.size());
        for (std::uint32_t i = 0; i < members.size(); ++i) {
            const Object& object = graph_.objects[members[i]];
            for (std::uint32_t k = 0; k < object.instances.size(); ++k)
                inside[places_[object.instances[k].master]].push_back(
                    {members[i], k, shares[i] * object.instances[k].chance});
        }
        for (std::size_t i = 0; i < members.size(); ++i)
            game_.states_[members[i]].wander = add_moves(inside[i], 0, true);
    }

    /// The mean colour of the materials that the core's instances name, if any does.
    std::optional<Rgb> mean_material(std::uint32_t c, const std::vector<double>& shares) const {
        Rgb sum(0.0);
        double weight = 0;
        const std::vector<ObjectId>& members = components_.members[c];
        for (std::size_t i = 0; i < members.size(); ++i)
            for (const Instance& instance : graph_.objects[members[i]].instances) {
                if (!instance.material) continue;
                const double part = shares[i] * instance.chance;
                sum += part * graph_.materials[*instance.material].rgb;
                weight += part;
            }
        if (!(weight > 0)) return std::nullopt;
        return sum / weight;
    }

    AliasTables::Range add_moves(const std::vector<Arrival>& arrivals, double ends, bool in_core) {
        const auto first = static_cast<std::uint32_t>(game_.moves_.size());
        std::vector<double> weights;
        for (const Arrival& arrival : arrivals) {
            const Instance& instance = graph_.objects[arrival.user].instances[arrival.instance];
            const bool cyclic = in_core || components_.component_of[arrival.user] ==
                                               components_.component_of[instance.master];
            Move move;
            move.map = instance.parent_from_child;
            move.paint = Paint(PathTint(instance.tint));
            move.to = arrival.user;
            move.material = instance.material.value_or(none);
            move.label = cyclic ? label_of(move.map) : 0;
            move.identity = move.map == Affine();
            game_.moves_.push_back(move);
            weights.push_back(arrival.visits);
        }
        if (ends > 0) {
            game_.moves_.push_back({});
            weights.push_back(ends);
        }
        return game_.tables_.add(weights, first);
    }

    std::uint32_t label_of(const Affine& map) {
        const auto [known, fresh] = labels_.try_emplace(map, game_.map_count_ + 1);
        if (fresh) ++game_.map_count_;
        return known->second;
    }

    void add_climb(ObjectId id) {
        const double ends = id == graph_.root ? 1 : 0;
        State& state = game_.states_[id];
        state.at_root = ends > 0 && arrivals_[id].empty();
        if (!state.at_root && (ends > 0 || !arrivals_[id].empty()))
            state.climb = add_moves(arrivals_[id], ends, false);
    }

    /// Whether every way from the core to the root leaves points as they are.
    bool is_in_world(std::size_t core) const {
        const ObjectId any = first_of_core_[core];
        for (const ObjectId id : components_.members[components_.component_of[any]]) {
            if (game_.states_[id].at_root) continue;
            for (const Arrival& arrival : arrivals_[id]) {
                const Instance& instance = graph_.objects[arrival.user].instances[arrival.instance];
                if (!(instance.parent_from_child == Affine()) || instance.tint.alpha != 0 ||
                    instance.material || !game_.states_[arrival.user].at_root)
                    return false;
            }
        }
        return true;
    }

    struct Before {
        bool operator()(const Affine& a, const Affine& b) const { return before(a, b); }
    };

    Graph graph_;
    Components components_;
    std::vector<double> begins_;                 ///< by object: walks that come from outside its component
    std::vector<std::vector<Arrival>> arrivals_; ///< by object: on the ways that points climb
    const std::vector<ObjectBounds>& bounds_;
    std::vector<std::uint32_t> places_;
    std::vector<double> source_weights_;
    std::vector<ObjectId> first_of_core_;
    std::map<Affine, std::uint32_t, Before> labels_;
    ChaosGame game_;
};

std::optional<ChaosGame> ChaosGame::of(const Graph& graph, const Components& components,
                                       const std::vector<ObjectBounds>& bounds, double rate) {
    return Builder(graph, components, bounds, rate).build();
}

} // namespace graftal
