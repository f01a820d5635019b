#include "compiler/inst/ink.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/inst/lower_scatter.h"
#include "compiler/inst/variant_name.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/support/hue.h"
#include "compiler/support/number.h"
#include "compiler/support/srgb.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

using StepKind = InstInkStep::Kind;

/// Objects that new inks may make; later inks are the nearest that there are.
constexpr std::size_t most_new_objects = 100'000;
/// Inks of an object that are looked at for the nearest: its last ones.
constexpr std::size_t most_neighbours = 256;
/// Steps of each channel that tell inks apart.
constexpr double ink_steps = 65'536;

double wrapped_degrees(double degrees) {
    const double inside = degrees - 360 * std::floor(degrees / 360);
    return inside < 360 ? inside : 0;
}

/// Whether clamping between the two factors changes nothing.
bool are_alike(double a, double b) {
    return (a <= 1 && b <= 1) || (a >= 1 && b >= 1);
}

bool take_in(InkStep& step, const InkStep& later) {
    if (step.kind != later.kind || step.channel != later.channel) return false;
    switch (step.kind) {
    case StepKind::set:
        step = later;
        return true;
    case StepKind::change:
        if (step.channel == InkChannel::hue) {
            step.number = std::fmod(step.number + later.number, 360.0);
            return true;
        }
        if (!are_alike(step.number, later.number)) return false;
        step.number = std::min(step.number * later.number, 1e100);
        return true;
    case StepKind::toward:
        if (step.channel == InkChannel::hue || step.number != later.number) return false;
        step.share = 1 - (1 - step.share) * (1 - later.share);
        return true;
    case StepKind::upward:
    case StepKind::downward:
        return false;
    }
    return false;
}

/// The names of what a graph already has, and new ones.
class FreeNames {
  public:
    void take(const std::string& name) { taken_.insert(name); }

    /// `tip.ink7(2)` for `tip(2)`.
    std::string like(const std::string& name) { return free_variant_name(name, "ink", taken_, numbers_); }

  private:
    std::set<std::string> taken_;
    std::map<std::string, unsigned> numbers_;
};

/// The objects under their inks.
class InkStates {
  public:
    InkStates(const Graph& source, const InkTable& inks, const HueTable& hues, Span place, Lowering& lowering)
        : source_(source), graph_(source), inks_(inks), hues_(hues), place_(place),
          most_(lowering.options.max_objects),
          most_new_(std::min(most_, std::max(most_new_objects, 2 * source.objects.size()))),
          lowering_(lowering), work_left_(lowering.meter.left()) {
        for (const Object& object : graph_.objects)
            names_.take(object.name);
        for (const Material& material : graph_.materials)
            material_names_.take(material.name);
        instances_ = instance_count(graph_);
    }

    /// False if the states make too many objects.
    bool run() {
        for (const auto& [id, changes] : inks_)
            write(id, id, {});
        while (!open_.empty() && good_ && !left_out_) {
            const Open next = open_.front();
            open_.pop_front();
            write(next.from, next.id, next.ink);
        }
        return good_;
    }

    bool left_out() const { return left_out_; }
    bool merged() const { return merged_; }
    Graph take_graph() { return std::move(graph_); }
    HueTable take_hues() { return std::move(hues_); }

  private:
    using Key = std::array<std::int32_t, ink_channels>;

    struct Open {
        ObjectId from; ///< in the source
        ObjectId id;
        Ink ink;
    };

    Key key_of(const Ink& ink) const {
        Key key{};
        for (std::size_t i = 0; i < ink_channels; ++i) {
            const double share = i == 0 ? ink.channels[i] / 360 : ink.channels[i];
            key[i] = static_cast<std::int32_t>(std::lround(share * ink_steps));
        }
        key[0] %= static_cast<std::int32_t>(ink_steps);
        return key;
    }

    /// Writes the object as it is under an ink into `id`.
    void write(ObjectId from, ObjectId id, std::optional<Ink> ink) {
        const auto changes = inks_.find(from);
        const Object& source = source_.objects[from];
        lowering_.meter.add(1, StagePrice::copied_object);
        lowering_.meter.add(source.instances.size(), StagePrice::copied_instance);
        std::vector<Instance> instances = source.instances;
        static const InkChange none;
        for (std::size_t i = 0; i < instances.size() && good_; ++i)
            hand_down(instances[i], changes == inks_.end() ? none : changes->second.instances[i], ink);
        std::optional<Instance> terminal = source.terminal;
        if (terminal) hand_down(*terminal, changes == inks_.end() ? none : changes->second.terminal, ink);
        graph_.objects[id].instances = std::move(instances);
        graph_.objects[id].terminal = std::move(terminal);
    }

    void hand_down(Instance& instance, const InkChange& change, const std::optional<Ink>& around) {
        const std::optional<Ink> ink = change.apply(around);
        if (!ink) return;
        const Object& master = source_.objects[instance.master];
        if (!master.primitive && !master.packed) {
            instance.master = state(instance.master, *ink);
            return;
        }
        using enum InkChannel;
        const Rgb screen = rgb_from_hsv((*ink)[hue], (*ink)[saturation], (*ink)[value]);
        instance.tint = composed({Tint{linear_from_srgb(screen), 1}, instance.tint});
        if ((*ink)[alpha] < 1) instance.material = sheer(instance.material, (*ink)[alpha]);
    }

    ObjectId state(ObjectId from, const Ink& ink) {
        const auto [known, fresh] = states_.try_emplace({from, key_of(ink)}, 0);
        if (!fresh) return known->second;
        std::vector<std::pair<Ink, ObjectId>>& others = by_object_[from];
        if (graph_.objects.size() >= most_new_ && !others.empty()) {
            merged_ = true;
            return known->second = nearest(others, ink);
        }
        instances_ += source_.objects[from].instances.size();
        if (!left_out_)
            left_out_ = leaves_out_colours(graph_.objects.size(), instances_, work_left_, place_, lowering_);
        if (left_out_) return from;
        if (graph_.objects.size() >= most_ || instances_ > most_ * max_instances_per_object) {
            good_ = false;
            return from;
        }
        Object copy = source_.objects[from];
        copy.name = names_.like(copy.name);
        known->second = graph_.add(std::move(copy));
        if (const auto hues = hues_.find(from); hues != hues_.end()) hues_[known->second] = hues->second;
        others.emplace_back(ink, known->second);
        open_.push_back({from, known->second, ink});
        return known->second;
    }

    static ObjectId nearest(const std::vector<std::pair<Ink, ObjectId>>& others, const Ink& ink) {
        const auto distance = [&](const std::pair<Ink, ObjectId>& other) {
            double sum = 0;
            for (std::size_t i = 0; i < ink_channels; ++i) {
                double apart = std::abs(other.first.channels[i] - ink.channels[i]);
                if (i == 0) apart = std::min(apart, 360 - apart) / 180;
                sum += apart * apart;
            }
            return sum;
        };
        const std::size_t first = others.size() - std::min(others.size(), most_neighbours);
        return std::ranges::min_element(others.begin() + static_cast<std::ptrdiff_t>(first), others.end(), {},
                                        distance)
            ->second;
    }

    /// The material, or a plain one, that lets the rest of the light through, to 1/64.
    MaterialId sheer(const std::optional<MaterialId>& material, double alpha) {
        const auto steps = static_cast<int>(std::lround(64 * alpha));
        const auto [known, fresh] = sheer_.try_emplace({material, steps}, 0);
        if (!fresh) return known->second;
        Material copy = material ? source_.materials[*material] : Material();
        if (!material) copy.name = "plain";
        // Light that the ink leaves out goes through as it is, the rest as the material says.
        const double coloured = copy.transparency * copy.filter * steps / 64.0;
        copy.transparency = 1 - (1 - copy.transparency) * steps / 64.0;
        copy.filter = copy.transparency > 0 ? coloured / copy.transparency : 1;
        copy.name = material_names_.like(copy.name);
        graph_.materials.push_back(std::move(copy));
        return known->second = static_cast<MaterialId>(graph_.materials.size() - 1);
    }

    const Graph& source_;
    Graph graph_;
    const InkTable& inks_;
    HueTable hues_;
    Span place_;
    std::size_t most_;
    std::size_t most_new_;
    Lowering& lowering_;
    double work_left_; ///< at the beginning
    std::map<std::pair<ObjectId, Key>, ObjectId> states_;
    std::map<std::pair<std::optional<MaterialId>, int>, MaterialId> sheer_;
    std::map<ObjectId, std::vector<std::pair<Ink, ObjectId>>> by_object_;
    std::deque<Open> open_;
    FreeNames names_, material_names_;
    std::size_t instances_ = 0;
    bool good_ = true;
    bool merged_ = false;
    bool left_out_ = false;
};

class StepLowerer {
  public:
    StepLowerer(const Environment& environment, Diagnostics& diagnostics, const ChanceDraws& draws)
        : environment_(environment), diagnostics_(diagnostics), draws_(draws) {}

    std::optional<InkStep> lower(const InstInkStep& step) {
        InkStep lowered{.kind = step.kind, .channel = step.channel};
        if (step.kind == StepKind::set) return lower_set(step, lowered);
        const bool hue = step.channel == InkChannel::hue;
        const bool toward = step.kind != StepKind::change;
        const double most = hue ? 1e6 : toward ? 1 : 1e6;
        const std::optional<double> number = in_range(step.values[0], hue ? -most : 0, most,
                                                      hue      ? "a hue"
                                                      : toward ? "this target"
                                                               : "this factor");
        if (!number) return std::nullopt;
        lowered.number = toward && hue ? wrapped_degrees(*number) : *number;
        if (!toward) return lowered;
        const std::optional<double> share = in_range(step.values[1], 0, 1, "the share of the way");
        if (!share) return std::nullopt;
        lowered.share = *share;
        return lowered;
    }

  private:
    std::optional<double> in_range(const Expression& value, double least, double most, const char* what) {
        const std::optional<double> number = evaluate(value, environment_, diagnostics_, draws_);
        if (!number || (*number >= least && *number <= most)) return number;
        diagnostics_.error(value.span, fmt::format("{} must lie between {} and {}, not at {}", what,
                                                   shortest(least), shortest(most), shortest(*number)));
        return std::nullopt;
    }

    std::optional<InkStep> lower_set(const InstInkStep& step, InkStep lowered) {
        std::array<double, 3> numbers{};
        const bool hsv = step.values.size() == 1;
        const std::vector<Expression>& values = hsv ? step.values[0].operands : step.values;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const bool hue = hsv && i == 0;
            const std::optional<double> number =
                in_range(values[i], hue ? -1e6 : 0, hue ? 1e6 : 1, hue ? "a hue" : "a number of a colour");
            if (!number) return std::nullopt;
            numbers[i] = hue ? wrapped_degrees(*number) : *number;
        }
        const Rgb given(numbers[0], numbers[1], numbers[2]);
        const Hsv colour = hsv ? Hsv{given.r, given.g, given.b} : hsv_from_rgb(given);
        lowered.ink.channels = {colour.hue_deg, colour.saturation, colour.value, 1};
        return lowered;
    }

    const Environment& environment_;
    Diagnostics& diagnostics_;
    const ChanceDraws& draws_;
};

} // namespace

void InkChange::add(const InkStep& step) {
    if (step.kind == StepKind::set) steps_.clear();
    // Steps of different channels can change places.
    for (auto before = steps_.rbegin(); before != steps_.rend(); ++before) {
        if (take_in(*before, step)) return;
        if (before->kind == StepKind::set || before->channel == step.channel) break;
    }
    steps_.push_back(step);
}

void InkChange::add(const InkChange& later) {
    for (const InkStep& step : later.steps_)
        add(step);
}

std::optional<Ink> InkChange::apply(std::optional<Ink> ink) const {
    for (const InkStep& step : steps_) {
        if (step.kind == StepKind::set) {
            ink = step.ink;
            continue;
        }
        if (!ink) continue;
        double& number = (*ink)[step.channel];
        const bool hue = step.channel == InkChannel::hue;
        if (step.kind == StepKind::upward)
            number += step.share * wrapped_degrees(step.number - number);
        else if (step.kind == StepKind::downward)
            number -= step.share * wrapped_degrees(number - step.number);
        else if (step.kind == StepKind::toward)
            number += step.share * (step.number - number);
        else
            number = hue ? number + step.number : number * step.number;
        number = hue ? wrapped_degrees(number) : std::clamp(number, 0.0, 1.0);
    }
    return ink;
}

std::optional<InkChange> lower_ink(const std::vector<InstInkStep>& steps, const Environment& environment,
                                   Diagnostics& diagnostics, const ChanceDraws& draws) {
    InkChange change;
    StepLowerer lowerer(environment, diagnostics, draws);
    bool good = true;
    for (const InstInkStep& step : steps) {
        const std::optional<InkStep> lowered = lowerer.lower(step);
        good = good && lowered;
        if (lowered) change.add(*lowered);
    }
    if (!good) return std::nullopt;
    return change;
}

bool apply_inks(Graph& graph, const InkTable& inks, HueTable& hues, Span place, Lowering& lowering) {
    const std::size_t most = lowering.options.max_objects;
    InkStates states(graph, inks, hues, place, lowering);
    if (states.run()) {
        if (states.left_out()) return true;
        if (states.merged())
            lowering.diagnostics.note(place,
                                      "there are too many different inks: the deepest parts have the nearest "
                                      "ink that their object has elsewhere");
        graph = states.take_graph();
        hues = states.take_hues();
        return true;
    }
    lowering.diagnostics
        .error(place, fmt::format("inks make more than {} objects or {} instances", most,
                                  most * max_instances_per_object))
        .with_hint("change the ink less often, or use changes that repeat, such as turns of 30 degrees");
    return false;
}

} // namespace graftal
