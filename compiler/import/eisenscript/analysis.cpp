#include "compiler/import/eisenscript/analysis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace graftal::eisenscript {

namespace {

/// Steps of the count: a second or two of work. A state counts for each number that it has.
constexpr std::size_t most_count_work = 12'000'000;
constexpr std::size_t most_states = 50'000;
/// Fallbacks that lead from one to the next.
constexpr int most_fallbacks = 64;

Affine map_of(const Operator& op) {
    const auto n = [&](std::size_t i) { return op.numbers[i].number; };
    switch (op.kind) {
    case Operator::Kind::x:
        return Affine::translate({n(0), 0, 0});
    case Operator::Kind::y:
        return Affine::translate({0, n(0), 0});
    case Operator::Kind::z:
        return Affine::translate({0, 0, n(0)});
    case Operator::Kind::rx:
        return Affine::rotate({1, 0, 0}, n(0));
    case Operator::Kind::ry:
        return Affine::rotate({0, 1, 0}, n(0));
    case Operator::Kind::rz:
        return Affine::rotate({0, 0, 1}, n(0));
    case Operator::Kind::size:
        return Affine::scale(op.numbers.size() == 1 ? Vec3(n(0)) : Vec3(n(0), n(1), n(2)));
    case Operator::Kind::matrix: {
        Affine map;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                map.linear[column][row] = n(static_cast<std::size_t>(3 * row + column));
        return map;
    }
    case Operator::Kind::reflect: {
        const Vec3 normal(n(0), n(1), n(2));
        const double squared = glm::dot(normal, normal);
        Affine map;
        if (!(squared > 0)) return map;
        map.linear = Mat3(1.0) - (2 / squared) * glm::outerProduct(normal, normal);
        map.translation = map.linear * Vec3(0.5) - Vec3(0.5);
        return map;
    }
    default:
        return {};
    }
}

/// A state of Structure Synth's stack: a group, the counts that it knows, and its size. States of one key are
/// counted together.
using State = std::vector<double>; // group, size, counts

/// Grows the script generation by generation, as Structure Synth does, by mean numbers.
class Growth {
  public:
    Growth(const Script& script, const Limits& limits, const Analysis& analysis)
        : script_(script), limits_(limits), analysis_(analysis),
          sized_(limits.least_size || limits.most_size) {}

    /// Whether the limit of work ended the count.
    bool gave_up() const { return work_ > most_count_work; }

    /// False if there is an end without limits.
    bool run(int& generations, bool& by_objects, double& objects) {
        State top = {0, 1};
        now_[top] = 1;
        int generation = 0;
        bool reached = false;
        while ((!now_.empty() || primitives_ > 0) && generation < limits_.generations) {
            ++generation;
            next_.clear();
            objects_ += std::exchange(primitives_, 0);
            for (const auto& [state, number] : now_) {
                if (gave_up()) break;
                process(state, number);
            }
            now_ = std::move(next_);
            double waiting = primitives_;
            for (const auto& [state, number] : now_)
                waiting += number;
            reached = objects_ >= limits_.objects || waiting >= limits_.objects;
            if (now_.size() > most_states) work_ = most_count_work + 1;
            if (reached || gave_up()) break;
        }
        objects = objects_;
        generations = generation;
        by_objects = reached;
        return !now_.empty() || primitives_ > 0;
    }

  private:
    bool in_size(double size) const {
        const double diagonal = size * std::numbers::sqrt3;
        return !(limits_.least_size && diagonal < *limits_.least_size) &&
               !(limits_.most_size && diagonal > *limits_.most_size);
    }

    void process(const State& state, double number) {
        if (sized_ && !in_size(state[1])) return;
        apply(state, number, 0);
    }

    void apply(const State& state, double number, int fallbacks) {
        const Group& group = analysis_.groups()[static_cast<std::size_t>(state[0])];
        double sum = 0;
        for (const std::size_t rule : group.rules)
            sum += script_.rules[rule].weight.number;
        for (const std::size_t rule : group.rules) {
            if (gave_up()) return;
            const double share = group.rules.size() == 1 ? 1
                                 : sum > 0               ? script_.rules[rule].weight.number / sum
                                                         : 0;
            if (share > 0) apply_rule(rule, group, state, number * share, fallbacks);
        }
    }

    void apply_rule(std::size_t index, const Group& group, const State& state, double number, int fallbacks) {
        const Rule& rule = script_.rules[index];
        const auto counter = std::ranges::find(group.counters, index);
        State inner = state;
        if (counter != group.counters.end()) {
            double& left = inner[2 + static_cast<std::size_t>(counter - group.counters.begin())];
            if (left <= 0) {
                left = *rule.depth;
                if (rule.fallback && fallbacks < most_fallbacks) {
                    work_ += inner.size();
                    const State next = called(rule.fallback->text, group, inner, 1);
                    if (!next.empty()) apply(next, number, fallbacks + 1);
                }
                return;
            }
            left -= 1;
        }
        work_ += inner.size();
        for (const Action& action : rule.actions)
            if (!gave_up()) act(action, group, inner, number);
    }

    void act(const Action& action, const Group& group, const State& state, double number) {
        if (!sized_) {
            double copies = 1;
            for (const Loop& loop : action.loops)
                copies *= std::max(1.0, loop.count.number);
            return call(action.target.text, group, state, number * copies, 1);
        }
        std::map<double, double> sizes = {{1, 1}}; // and how many there are
        for (const Loop& loop : action.loops) {
            std::map<double, double> grown;
            const double growth = growth_of(loop);
            const int count = std::max(1, static_cast<int>(loop.count.number));
            for (const auto& [size, times] : sizes) {
                double power = 1;
                if (growth == 1) grown[size] += times * count;
                for (int i = 0; growth != 1 && i < count && !gave_up(); ++i, ++work_)
                    grown[size * (power *= growth)] += times;
            }
            sizes = std::move(grown);
        }
        for (const auto& [size, times] : sizes)
            if (!gave_up()) call(action.target.text, group, state, number * times, size);
    }

    void call(const std::string& name, const Group& group, const State& state, double number, double growth) {
        work_ += state.size();
        const State next = called(name, group, state, growth);
        if (!next.empty())
            next_[next] += number;
        else if (!sized_ || in_size(state[1] * growth))
            primitives_ += number;
    }

    /// Empty of primitives.
    State called(const std::string& name, const Group& from, const State& state, double growth) const {
        const Group* const to = analysis_.group(name);
        if (!to) return {};
        State next = {static_cast<double>(to - analysis_.groups().data()), sized_ ? state[1] * growth : 1};
        if (to->recurs && to->component == from.component) { // then they know the same counts
            next.insert(next.end(), state.begin() + 2, state.end());
            return next;
        }
        for (const std::size_t counter : to->counters) {
            const auto known = std::ranges::find(from.counters, counter);
            next.push_back(known == from.counters.end()
                               ? *script_.rules[counter].depth
                               : state[2 + static_cast<std::size_t>(known - from.counters.begin())]);
        }
        return next;
    }

    const Script& script_;
    const Limits& limits_;
    const Analysis& analysis_;
    bool sized_;
    std::map<State, double> now_, next_;
    double primitives_ = 0; ///< primitives of the next generation
    double objects_ = 0;
    std::size_t work_ = 0;
};

} // namespace

Affine map_of(const Loop& loop) {
    Affine map;
    for (const Operator& op : loop.operators)
        if (op.moves()) map = map * map_of(op);
    return map;
}

double growth_of(const Loop& loop) {
    double growth = 1; // factor by factor, so that plain sizes stay plain numbers
    for (const Operator& op : loop.operators) {
        if (op.kind == Operator::Kind::size && op.numbers.size() == 1)
            growth *= std::abs(op.numbers[0].number);
        else if (op.kind == Operator::Kind::size || op.kind == Operator::Kind::matrix)
            growth *= glm::length(map_of(op).linear * Vec3(1.0)) / std::numbers::sqrt3;
    }
    return growth;
}

Analysis::Analysis(const Script& script, const Limits& limits) : script_(script), limits_(limits) {
    for (std::size_t rule = 0; rule < script.rules.size(); ++rule) {
        const std::string name = rule == 0 ? std::string() : script.rules[rule].name.text;
        const auto [known, fresh] = by_name_.try_emplace(name, groups_.size());
        if (fresh) groups_.push_back({.name = name});
        groups_[known->second].rules.push_back(rule);
        group_of_rule_.push_back(known->second);
    }
    const Components components = find_components();
    if (too_deep()) return;
    find_heights(components);
    count();
}

const Group* Analysis::too_deep() const {
    const auto found = std::ranges::find_if(
        groups_, [](const Group& group) { return group.counters.size() > most_counters; });
    return found == groups_.end() ? nullptr : &*found;
}

const Group* Analysis::group(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : &groups_[found->second];
}

Components Analysis::find_components() {
    Graph calls; // groups as objects
    for (const Group& from : groups_) {
        Object& object = calls.objects.emplace_back();
        const auto add = [&](const std::string& name) {
            if (const Group* const to = group(name))
                object.instances.emplace_back().master = static_cast<ObjectId>(to - groups_.data());
        };
        for (const std::size_t rule : from.rules) {
            for (const Action& action : script_.rules[rule].actions)
                add(action.target.text);
            if (script_.rules[rule].fallback) add(script_.rules[rule].fallback->text);
        }
    }
    Components found = strong_components(calls);
    for (std::size_t component = 0; component < found.members.size(); ++component) {
        std::vector<std::size_t> counters;
        for (const ObjectId member : found.members[component]) {
            groups_[member].component = component;
            groups_[member].recurs = found.cyclic[component];
            for (const std::size_t rule : groups_[member].rules)
                if (script_.rules[rule].depth) counters.push_back(rule);
        }
        std::ranges::sort(counters);
        if (counters.size() > most_counters) counters.resize(most_counters + 1); // more than is read
        if (found.cyclic[component])
            for (const ObjectId member : found.members[component])
                groups_[member].counters = counters;
    }
    return found;
}

/// Components are numbered from the ends of the calls upwards.
void Analysis::find_heights(const Components& components) {
    for (const std::vector<ObjectId>& members : components.members)
        for (const ObjectId id : members) {
            Group& group = groups_[id];
            group.endless = group.recurs;
            group.height = 1;
            const auto look = [&](const std::string& name, std::size_t generations) {
                const Group* const to = this->group(name);
                group.endless = group.endless || (to && to->endless);
                group.height = std::max(group.height, to ? to->height + generations : 1 + generations);
            };
            for (const std::size_t rule : group.rules) {
                for (const Action& action : script_.rules[rule].actions)
                    look(action.target.text, 1);
                if (script_.rules[rule].fallback) look(script_.rules[rule].fallback->text, 0);
            }
        }
}

void Analysis::count() {
    int generations = 0;
    Growth growth(script_, limits_, *this);
    if (growth.run(generations, by_objects_, objects_)) generations_ = generations;
    gave_up_ = growth.gave_up();
}

} // namespace graftal::eisenscript
