#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "compiler/editing/maps/least_change.h"
#include "compiler/editing/maps/map_table.h"
#include "compiler/editing/maps/maps.h"
#include "compiler/languages/lower.h"
#include "compiler/zoom/address.h"

namespace graftal {

namespace {

/// The place where the point has to be is met to within this much of the model's size.
constexpr double arrives = 1e-11;
/// Steps of an address that count: behind them, a map that halves moves nothing that doubles tell.
constexpr std::size_t most_address_steps = 400;

/// One step down: a map whose numbers may change, or one that stays.
struct Step {
    std::optional<std::size_t> map; ///< in the table of written maps
    Affine fixed;
};

/// The way of an address through the graph.
struct Way {
    std::vector<Step> steps, cycle;
    std::string fault;
};

class Puller {
  public:
    Puller(const Document& document, const EditContext& context, const Hand& hand)
        : document_(document), context_(context), hand_(hand),
          maps_(written_maps(document, lets_of(document, context.lower))) {
        for (std::size_t i = 0; i < maps_.size(); ++i)
            for (const Span place : maps_[i].places)
                by_place_.emplace(place.begin, i);
    }

    MapChange run(std::string_view address, Vec3 from, Vec3 to) {
        const Way way = find(address);
        if (!way.fault.empty()) return {{}, way.fault};
        number_maps(way);
        if (numbers_.empty()) return {{}, "No map on this address can be moved."};
        const Point start = point(numbers_, way, Vec3(0.0));
        const bool endless = !way.cycle.empty();
        // The place in the frame of the last object.
        const Vec3 local = endless ? Vec3(0.0) : back(way, from);
        if (!start) return {{}, "The maps that the address repeats do not contract."};
        MapChange change;
        for (const bool everything : {true, false}) {
            const auto solved = solve(way, local, to, everything);
            if (!solved) continue;
            change = changed(*solved);
            if (change.contracts) return change;
        }
        if (change.edits.empty() && change.refusal.empty())
            return {{}, "The maps on this address cannot bring the point there."};
        return change;
    }

  private:
    using Point = std::optional<Vec3>;

    Way find(std::string_view text) {
        std::string problem;
        const std::optional<Address> address = parse_address(text, problem);
        if (!address) return {{}, {}, fmt::format("The address cannot be read: {}.", problem)};
        SourceMap sources;
        Diagnostics diagnostics;
        const LoweredText lowered = lower_text(document_.name(), std::string(document_.text()),
                                               context_.lower, sources, diagnostics, context_.help);
        if (!lowered.graph) return {{}, {}, "The text has errors."};
        const std::optional<GraphPath> path = find_path(*lowered.graph, *address, diagnostics);
        if (!path) return {{}, {}, diagnostics.all().empty() ? "" : diagnostics.all().back().message + "."};
        Way way;
        ObjectId last = lowered.graph->root;
        const auto take = [&](const std::vector<GraphStep>& steps, std::vector<Step>& into) {
            for (const GraphStep& step : steps) {
                if (into.size() == most_address_steps) break;
                const Object& object = lowered.graph->objects[step.object];
                if (step.instance >= object.instances.size()) continue; // of a run: no text has it
                const Instance& instance = object.instances[step.instance];
                into.push_back(step_of(instance));
                last = instance.master;
            }
        };
        take(path->steps, way.steps);
        take(path->cycle, way.cycle);
        if (way.cycle.empty()) add_own_map(lowered.graph->objects[last], way);
        return way;
    }

    Step step_of(const Instance& instance) const {
        const auto found = by_place_.find(instance.span.begin);
        if (found != by_place_.end()) {
            const std::optional<MapForm>& form = maps_[found->second].form;
            if (form && form->matrix() == instance.parent_from_child) return {found->second, Affine()};
        }
        return {std::nullopt, instance.parent_from_child};
    }

    /// All that the object of a map holds lies under this map.
    void add_own_map(const Object& object, Way& way) const {
        const auto found = std::ranges::find_if(maps_, [&](const WrittenMap& map) {
            return map.row && map.form && map.places.front() == object.span;
        });
        if (found != maps_.end())
            way.steps.push_back({static_cast<std::size_t>(found - maps_.begin()), Affine()});
    }

    /// Gives each map on the way its place among the numbers.
    void number_maps(const Way& way) {
        for (const auto* steps : {&way.steps, &way.cycle})
            for (const Step& step : *steps) {
                if (!step.map || first_.contains(*step.map)) continue;
                first_[*step.map] = numbers_.size();
                const MapForm& form = *maps_[*step.map].form;
                numbers_.insert(numbers_.end(), form.values().begin(), form.values().end());
                for (std::size_t i = 0; i < form.values().size(); ++i)
                    units_.push_back(form.unit(i));
            }
    }

    std::vector<double> numbers_of(std::size_t map, const std::vector<double>& numbers) const {
        const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(first_.at(map));
        return {begin, begin + static_cast<std::ptrdiff_t>(maps_[map].form->values().size())};
    }

    /// The product of the maps; nothing where numbers make no map.
    std::optional<Affine> product(const std::vector<Step>& steps, const std::vector<double>& numbers) const {
        Affine all;
        for (const Step& step : steps) {
            const std::optional<Affine> map =
                step.map ? maps_[*step.map].form->at(numbers_of(*step.map, numbers)) : step.fixed;
            if (!map) return std::nullopt;
            all = all * *map;
        }
        return all;
    }

    /// The point of the address; `local`: of a finite one, in the last frame.
    Point point(const std::vector<double>& numbers, const Way& way, Vec3 local) const {
        const std::optional<Affine> ahead = product(way.steps, numbers);
        if (!ahead) return std::nullopt;
        if (way.cycle.empty()) return (*ahead)(local);
        const std::optional<Affine> around = product(way.cycle, numbers);
        if (!around) return std::nullopt;
        const Mat3 rest = Mat3(1.0) - around->linear;
        if (is_singular({rest, Vec3(0.0)})) return std::nullopt;
        return (*ahead)(glm::inverse(rest) * around->translation);
    }

    /// A point that the way's maps take to this place; of maps that flatten, the origin in their frame.
    Vec3 back(const Way& way, Vec3 place) const {
        for (const Step& step : way.steps) {
            const Affine map = step.map ? maps_[*step.map].form->matrix() : step.fixed;
            if (is_singular(map)) return Vec3(0.0);
            place = inverse(map)(place);
        }
        return place;
    }

    /// `everything`: all numbers may change, else only those that translate.
    std::optional<std::vector<double>> solve(const Way& way, Vec3 local, Vec3 to, bool everything) const {
        std::vector<double> units = units_;
        if (!everything)
            for (const auto& [map, first] : first_)
                for (std::size_t i = 0; i < maps_[map].form->values().size(); ++i)
                    if (!maps_[map].form->translates(i)) units[first + i] = 0;
        const double scale = std::max(largest_entry(to), 1.0);
        return solve_by_least_change(
            numbers_, units,
            [&](const std::vector<double>& numbers) -> std::optional<std::vector<double>> {
                const Point now = point(numbers, way, local);
                if (!now) return std::nullopt;
                const Vec3 left = (*now - to) / scale;
                return std::vector<double>{left.x, left.y, left.z};
            },
            arrives);
    }

    MapChange changed(const std::vector<double>& numbers) const {
        MapChange change;
        for (const auto& [map, first] : first_) {
            const MapForm& form = *maps_[map].form;
            const std::vector<double> own = form.rounded(numbers_of(map, numbers), hand_);
            std::ranges::move(form.edits(document_, own), std::back_inserter(change.edits));
            if (const auto matrix = form.at(own)) change.ratio = std::max(change.ratio, norm(matrix->linear));
        }
        const ContractionCheck check =
            check_contraction(document_.name(), applied(document_.text(), change.edits), context_);
        change.contracts = check.contracts;
        change.why = check.why;
        return change;
    }

    const Document& document_;
    const EditContext& context_;
    const Hand hand_;
    std::vector<WrittenMap> maps_;
    std::map<std::uint32_t, std::size_t> by_place_; ///< of the span that instances have
    std::map<std::size_t, std::size_t> first_;      ///< by map, the first of its numbers
    std::vector<double> numbers_, units_;
};

} // namespace

MapChange pull(const Document& document, std::string_view address, Vec3 from, Vec3 to,
               const EditContext& context, const Hand& hand) {
    return Puller(document, context, hand).run(address, from, to);
}

} // namespace graftal
