#include "compiler/inst/hues.h"

#include <cmath>
#include <deque>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "compiler/inst/variant_name.h"
#include "compiler/support/hue.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

constexpr std::int64_t finest_turn = 3600;
constexpr std::int64_t largest_denominator = 100'000;
/// A share of a turn to rounding, as degrees are computed.
constexpr double slack = 1e-12;

/// Into [0, 1).
double wrapped(double turns) {
    const double inside = turns - std::floor(turns);
    return inside < 1 ? inside : 0;
}

HueTurn reduced(std::int64_t part, std::int64_t whole) {
    part %= whole;
    const std::int64_t common = std::gcd(part, whole);
    return {part / common, whole / common};
}

class HueStates {
  public:
    HueStates(Graph& graph, const HueTable& hues, Span place, Lowering& lowering)
        : graph_(graph), source_(graph), hues_(hues), place_(place), lowering_(lowering) {
        for (const Object& object : graph_.objects)
            names_.insert(object.name);
        for (const Material& material : graph_.materials)
            material_names_.insert(material.name);
        instances_ = instance_count(graph_);
        work_left_ = lowering.meter.left();
        find_coloured();
    }

    bool run() {
        for (const auto& [id, turns] : hues_)
            turn_object(id, id, {});
        while (!open_.empty() && good_ && !left_out_) {
            const auto [from, turn, id] = open_.front();
            open_.pop_front();
            turn_object(from, id, turn);
        }
        if (left_out_) graph_ = std::move(source_);
        return good_;
    }

  private:
    struct Open {
        ObjectId from; ///< in the source
        HueTurn turn;
        ObjectId id;
    };

    bool is_coloured(const std::optional<MaterialId>& material) const {
        return material &&
               (!is_grey(source_.materials[*material].rgb) || source_.materials[*material].is_painted());
    }

    bool is_coloured(const Instance& instance) const {
        return (instance.tint.alpha > 0 && !is_grey(instance.tint.rgb)) || is_coloured(instance.material);
    }

    /// The objects under which a turn changes anything.
    void find_coloured() {
        coloured_.assign(source_.objects.size(), false);
        std::vector<std::vector<ObjectId>> users(source_.objects.size());
        std::vector<ObjectId> open;
        for (ObjectId id = 0; id < source_.objects.size(); ++id) {
            const Object& object = source_.objects[id];
            bool own = false;
            const auto look = [&](const Instance& instance) {
                users[instance.master].push_back(id);
                own = own || is_coloured(instance);
            };
            for (const Instance& instance : object.instances)
                look(instance);
            if (object.terminal) look(*object.terminal);
            for (const std::optional<MaterialId>& material : object.packed.materials)
                own = own || is_coloured(material);
            if (own) open.push_back(id);
            coloured_[id] = own;
        }
        while (!open.empty()) {
            const ObjectId id = open.back();
            open.pop_back();
            for (const ObjectId user : users[id])
                if (!coloured_[user]) coloured_[user] = true, open.push_back(user);
        }
    }

    /// Writes the object as it is with a turn into `id`.
    void turn_object(ObjectId from, ObjectId id, HueTurn turn) {
        const auto hues = hues_.find(from);
        const Object& source = source_.objects[from];
        lowering_.meter.add(1, StagePrice::copied_object);
        lowering_.meter.add(source.instances.size(), StagePrice::copied_instance);
        std::vector<Instance> instances = source.instances;
        for (std::size_t i = 0; i < instances.size() && good_; ++i)
            turn_instance(instances[i], hues == hues_.end() ? HueTurn() : hues->second.instances[i], turn);
        std::optional<Instance> terminal = source.terminal;
        if (terminal) turn_instance(*terminal, hues == hues_.end() ? HueTurn() : hues->second.terminal, turn);
        PackedEdges packed = source.packed;
        for (std::optional<MaterialId>& material : packed.materials)
            material = turned(material, turn);
        Object& object = graph_.objects[id];
        object.instances = std::move(instances);
        object.terminal = std::move(terminal);
        object.packed = std::move(packed);
    }

    void turn_instance(Instance& instance, HueTurn own, HueTurn around) {
        const std::optional<HueTurn> turn = sum(own, around);
        if (!turn) return fail("the turns of these hues have no small common denominator");
        instance.tint.rgb = hue_turned(instance.tint.rgb, turn->turns());
        instance.material = turned(instance.material, *turn);
        if (turn->part != 0 && coloured_[instance.master]) instance.master = state(instance.master, *turn);
    }

    ObjectId state(ObjectId from, HueTurn turn) {
        const auto [known, fresh] = states_.try_emplace({from, turn}, 0);
        if (!fresh) return known->second;
        instances_ += source_.objects[from].instances.size();
        if (!left_out_)
            left_out_ = leaves_out_colours(graph_.objects.size(), instances_, work_left_, place_, lowering_);
        if (left_out_) return known->second = from;
        const std::size_t most = lowering_.options.max_objects;
        if (graph_.objects.size() >= most || instances_ > most * max_instances_per_object) {
            fail(fmt::format("the turns of hues make more than {} objects or {} instances", most,
                             most * max_instances_per_object));
            return known->second = from;
        }
        Object copy = source_.objects[from];
        copy.name = free_variant_name(copy.name, "hue", names_, numbers_);
        known->second = graph_.add(std::move(copy));
        open_.push_back({from, turn, known->second});
        return known->second;
    }

    std::optional<MaterialId> turned(const std::optional<MaterialId>& material, HueTurn turn) {
        if (!material || turn.part == 0 || !is_coloured(material)) return material;
        const Material& source = source_.materials[*material];
        if (!source.texture.empty()) {
            if (pictures_.insert(*material).second)
                lowering_.diagnostics.note(
                    place_, fmt::format("'hue' does not change the picture of material '{}'", source.name));
            return material;
        }
        const auto [known, fresh] = materials_.try_emplace({*material, turn}, 0);
        if (fresh) {
            Material copy = source;
            for (Rgb* rgb : {&copy.rgb, &copy.pattern.low, &copy.pattern.high})
                *rgb = hue_turned(*rgb, turn.turns());
            copy.name = free_variant_name(copy.name, "hue", material_names_, numbers_);
            known->second = static_cast<MaterialId>(graph_.materials.size());
            graph_.materials.push_back(std::move(copy));
        }
        return known->second;
    }

    void fail(std::string message) {
        if (!std::exchange(good_, false)) return;
        lowering_.diagnostics.error(place_, std::move(message))
            .with_hint("use turns that add up to a whole circle soon, such as 30, 45 or 360/7 degrees");
    }

    Graph& graph_;
    Graph source_; ///< as it was
    const HueTable& hues_;
    Span place_;
    Lowering& lowering_;
    std::vector<bool> coloured_;
    std::map<std::pair<ObjectId, HueTurn>, ObjectId> states_;
    std::map<std::pair<MaterialId, HueTurn>, MaterialId> materials_;
    std::deque<Open> open_;
    std::set<std::string> names_, material_names_;
    std::map<std::string, unsigned> numbers_;
    std::set<MaterialId> pictures_; ///< pictures noted
    std::size_t instances_ = 0;
    double work_left_; ///< at the beginning
    bool left_out_ = false;
    bool good_ = true;
};

} // namespace

std::optional<HueTurn> exact_turn(double degrees) {
    const double turns = wrapped(degrees / 360);
    // Continued fractions: each convergent is the nearest fraction with a denominator of its size.
    std::int64_t part = 1, whole = 0, part_before = 0, whole_before = 1;
    double rest = turns;
    while (true) {
        const auto digit = static_cast<std::int64_t>(std::floor(rest));
        if (digit > finest_turn && whole > 0) return std::nullopt;
        const std::int64_t next_part = digit * part + part_before, next_whole = digit * whole + whole_before;
        if (next_whole > finest_turn) return std::nullopt;
        part_before = std::exchange(part, next_part);
        whole_before = std::exchange(whole, next_whole);
        if (std::abs(turns - static_cast<double>(part) / static_cast<double>(whole)) <= slack)
            return reduced(part, whole);
        const double fraction = rest - std::floor(rest);
        if (fraction == 0) return std::nullopt;
        rest = 1 / fraction;
    }
}

HueTurn whole_degrees(double degrees) {
    return reduced(static_cast<std::int64_t>(std::lround(360 * wrapped(degrees / 360))), 360);
}

std::optional<HueTurn> sum(HueTurn a, HueTurn b) {
    const std::int64_t whole = std::lcm(a.whole, b.whole);
    if (whole > largest_denominator) return std::nullopt;
    return reduced(a.part * (whole / a.whole) + b.part * (whole / b.whole), whole);
}

bool apply_hues(Graph& graph, const HueTable& hues, Span place, Lowering& lowering) {
    return HueStates(graph, hues, place, lowering).run();
}

} // namespace graftal
