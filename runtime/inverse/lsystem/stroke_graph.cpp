#include "runtime/inverse/lsystem/stroke_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "runtime/inverse/lsystem/place_grid.h"
#include "runtime/inverse/lsystem/stroke_angle.h"

namespace graftal {

namespace {

constexpr std::size_t most_length_classes = 40;
constexpr double most_cut_strokes = 2'000'000;

double stroke_length(const Stroke& stroke) {
    return std::hypot(stroke.to.x - stroke.from.x, stroke.to.y - stroke.from.y);
}

double direction_deg(const Stroke& stroke) {
    return std::atan2(stroke.to.y - stroke.from.y, stroke.to.x - stroke.from.x) * 180 / std::numbers::pi;
}

} // namespace

/// Makes the graph of one reading.
class StrokeGraphBuilder {
  public:
    StrokeGraphBuilder(const Strokes& strokes, double reach, WorkMeter& meter)
        : strokes_(strokes), reach_(reach), meter_(meter), cells_(2 * reach) {}

    /// False, with the problem, if there is no angle.
    bool build(StrokeGraph& graph, const std::vector<std::uint8_t>& classes, double noise_deg,
               std::string& problem) {
        graph.strokes = strokes_.size();
        find_places(graph);
        graph.first_deg = direction_deg(strokes_.front());
        for (const Stroke& stroke : strokes_)
            degrees_.push_back(wrapped_deg(direction_deg(stroke) - graph.first_deg));
        const auto follow = [&](double angle_deg) { return follow_turns(graph, angle_deg); };
        const std::optional<AngleGrid> grid =
            find_angle(degrees_, joint_turns(graph), noise_deg, follow, meter_);
        if (!grid) {
            problem = "no angle has all its directions as multiples";
            return false;
        }
        graph.angle_deg = grid->angle_deg;
        graph.directions = grid->directions;
        link(graph, classes, *grid);
        find_starts(graph);
        if (graph.starts.empty()) problem = "its lines do not all hang together";
        return !graph.starts.empty();
    }

  private:
    void find_places(StrokeGraph& graph) {
        for (const Stroke& stroke : strokes_) {
            ends_.push_back(place_of(graph, stroke.from));
            ends_.push_back(place_of(graph, stroke.to));
        }
    }

    std::uint32_t begin_of(std::size_t stroke) const { return ends_[2 * stroke]; }
    std::uint32_t end_of(std::size_t stroke) const { return ends_[2 * stroke + 1]; }

    /// The oldest place within reach: the answer for a point stays the same when more places come.
    std::optional<std::uint32_t> place_at(const StrokeGraph& graph, Vec2 point) const {
        std::optional<std::uint32_t> found;
        cells_.near(point, [&](std::uint32_t place) {
            const Vec2 away = graph.places[place] - point;
            if ((!found || place < *found) && std::hypot(away.x, away.y) <= reach_) found = place;
        });
        return found;
    }

    std::uint32_t place_of(StrokeGraph& graph, Vec2 point) {
        if (const auto found = place_at(graph, point)) return *found;
        const auto number = static_cast<std::uint32_t>(graph.places.size());
        graph.places.push_back(point);
        cells_.add(point, number);
        return number;
    }

    /// Turns between strokes of which one begins where the other ends, by size; at most so many a place.
    std::vector<double> joint_turns(const StrokeGraph& graph) const {
        constexpr std::size_t most_at_a_place = 6;
        std::vector<std::vector<std::uint32_t>> leaving(graph.places.size());
        for (std::uint32_t i = 0; i < strokes_.size(); ++i)
            if (leaving[begin_of(i)].size() < most_at_a_place) leaving[begin_of(i)].push_back(i);
        std::vector<double> turns;
        for (std::uint32_t i = 0; i < strokes_.size(); ++i)
            for (const std::uint32_t next : leaving[end_of(i)])
                turns.push_back(std::abs(wrapped_deg(degrees_[next] - degrees_[i])));
        return turns;
    }

    /// Finds directions that go round many times, from stroke to stroke; false if they are no multiples.
    bool follow_turns(const StrokeGraph& graph, double angle_deg) {
        meter_.add(strokes_.size());
        // Strokes of each place, until they are seen: else a place of many would be gone through for each.
        std::vector<std::vector<std::uint32_t>> unseen(graph.places.size());
        for (std::uint32_t i = 1; i < strokes_.size(); ++i)
            for (const std::uint32_t place : {begin_of(i), end_of(i)})
                unseen[place].push_back(i);
        std::vector<bool> seen(strokes_.size());
        followed_.assign(strokes_.size(), 0);
        const auto next_to = [&](std::uint32_t at, const auto& next) {
            for (const std::uint32_t place : {begin_of(at), end_of(at)}) {
                meter_.add(unseen[place].size());
                std::erase_if(unseen[place], [&](std::uint32_t other) {
                    if (seen[other]) return true;
                    const double turn = wrapped_deg(degrees_[other] - degrees_[at]);
                    const std::int32_t units = AngleGrid{angle_deg, 0}.units(turn);
                    if (std::abs(wrapped_deg(turn - units * angle_deg)) > fine_turn_deg) return false;
                    followed_[other] = followed_[at] + units;
                    next(other);
                    return true;
                });
            }
        };
        if (visit_from(0, seen, next_to) == strokes_.size()) return true;
        followed_.clear();
        return false;
    }

    void link(StrokeGraph& graph, const std::vector<std::uint8_t>& classes, const AngleGrid& grid) {
        struct Link {
            std::uint32_t from, to;
            std::int32_t direction;
            std::uint8_t length;
            auto operator<=>(const Link&) const = default;
        };
        std::vector<Link> links;
        for (std::uint32_t i = 0; i < strokes_.size(); ++i) {
            const std::int32_t direction = followed_.empty() ? grid.units(degrees_[i]) : followed_[i];
            links.push_back({begin_of(i), end_of(i), direction, classes[i]});
        }
        turn_by_mean(graph, links);
        std::ranges::sort(links, {}, [](const Link& link) {
            return std::tuple(link.from, link.direction, link.to, link.length);
        });
        graph.first_way_.assign(graph.places.size() + 1, 0);
        for (std::size_t i = 0; i < links.size(); ++i) {
            if (i > 0 && links[i] == links[i - 1]) {
                ++graph.copies.back();
                continue;
            }
            graph.ways_.push_back(
                {links[i].to, links[i].direction, static_cast<std::uint32_t>(graph.copies.size())});
            graph.copies.push_back(1);
            graph.classes.push_back(links[i].length);
            ++graph.first_way_[links[i].from + 1];
        }
        std::partial_sum(graph.first_way_.begin(), graph.first_way_.end(), graph.first_way_.begin());
    }

    /// Takes for direction 0 the mean of what all strokes say of it.
    template<typename Links> void turn_by_mean(StrokeGraph& graph, const Links& links) const {
        double sum = 0;
        for (std::size_t i = 0; i < links.size(); ++i)
            sum += wrapped_deg(degrees_[i] - links[i].direction * graph.angle_deg);
        graph.first_deg += sum / static_cast<double>(links.size());
    }

    /// A place from which ways lead to every other, if there is one: the last that a search begins at.
    static std::uint32_t mother_place(const StrokeGraph& graph) {
        std::vector<bool> seen(graph.places.size());
        std::uint32_t mother = 0;
        for (std::uint32_t place = 0; place < seen.size(); ++place)
            if (!seen[place]) {
                mother = place;
                visit_from(place, seen, [&](std::uint32_t at, const auto& next) {
                    for (const StrokeWay& way : graph.ways(at))
                        next(way.to);
                });
            }
        return mother;
    }

    template<typename Neighbours>
    static std::size_t visit_from(std::uint32_t place, std::vector<bool>& seen,
                                  const Neighbours& neighbours) {
        std::vector<std::uint32_t> waiting = {place};
        seen[place] = true;
        std::size_t count = 0;
        while (!waiting.empty()) {
            const std::uint32_t at = waiting.back();
            waiting.pop_back();
            ++count;
            neighbours(at, [&](std::uint32_t next) {
                if (seen[next]) return;
                seen[next] = true;
                waiting.push_back(next);
            });
        }
        return count;
    }

    /// The places that lead to all others; of a drawing in one sweep, the one where more strokes begin than
    /// end.
    void find_starts(StrokeGraph& graph) const {
        std::vector<std::int64_t> surplus(graph.places.size());
        std::vector<std::vector<std::uint32_t>> before(graph.places.size());
        for (std::size_t i = 0; i < strokes_.size(); ++i) {
            ++surplus[begin_of(i)];
            --surplus[end_of(i)];
            before[end_of(i)].push_back(begin_of(i));
        }
        std::int64_t sum = 0;
        for (const std::int64_t each : surplus)
            sum += std::max<std::int64_t>(0, each);
        graph.branches = sum > 1;
        const std::uint32_t mother = mother_place(graph);
        std::vector<bool> reached(graph.places.size()), leads(graph.places.size());
        const std::size_t count = visit_from(mother, reached, [&](std::uint32_t at, const auto& next) {
            for (const StrokeWay& way : graph.ways(at))
                next(way.to);
        });
        if (count < graph.places.size()) return;
        visit_from(mother, leads,
                   [&](std::uint32_t at, const auto& next) { std::ranges::for_each(before[at], next); });
        for (std::uint32_t place = 0; place < leads.size(); ++place)
            if (leads[place] && (graph.branches || sum == 0 || surplus[place] > 0))
                graph.starts.push_back(place);
        std::ranges::stable_sort(graph.starts, [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(a != ends_.front(), -surplus[a]) < std::pair(b != ends_.front(), -surplus[b]);
        });
        drop_turned_starts(graph);
    }

    /// The places that a turn about the middle takes the places to; none if it changes the drawing.
    std::vector<std::uint32_t> turned_places(const StrokeGraph& graph, Vec2 middle, double rad) const {
        std::vector<std::uint32_t> turned;
        for (const Vec2 place : graph.places) {
            const Vec2 p = place - middle;
            meter_.add();
            const auto found = place_at(graph, middle + Vec2(std::cos(rad) * p.x - std::sin(rad) * p.y,
                                                             std::sin(rad) * p.x + std::cos(rad) * p.y));
            if (!found) return {};
            turned.push_back(*found);
        }
        for (std::uint32_t place = 0; place < turned.size(); ++place)
            for (const StrokeWay& way : graph.ways(place)) {
                meter_.add();
                const auto ways = graph.ways(turned[place]);
                const bool same = std::ranges::any_of(ways, [&](const StrokeWay& other) {
                    return other.to == turned[way.to] &&
                           graph.copies[other.bundle] == graph.copies[way.bundle] &&
                           graph.classes[other.bundle] == graph.classes[way.bundle];
                });
                if (!same) return {};
            }
        return turned;
    }

    /// Keeps one of the starts that turns of the drawing onto itself exchange: a search at each would do the
    /// same.
    void drop_turned_starts(StrokeGraph& graph) const {
        Vec2 middle(0.0);
        for (const Vec2 place : graph.places)
            middle += place / static_cast<double>(graph.places.size());
        for (std::int32_t parts = graph.directions; parts > 1 && graph.starts.size() > 1; --parts) {
            if (graph.directions % parts != 0) continue;
            const std::vector<std::uint32_t> turned =
                turned_places(graph, middle, 2 * std::numbers::pi / parts);
            if (turned.empty()) continue;
            std::vector<bool> seen(graph.places.size());
            std::erase_if(graph.starts, [&](std::uint32_t start) {
                if (seen[start]) return true;
                for (std::int32_t i = 0; i < parts; ++i, start = turned[start])
                    seen[start] = true;
                return false;
            });
            return;
        }
    }

    const Strokes& strokes_;
    double reach_;
    WorkMeter& meter_;
    PlaceGrid cells_;                    ///< of places
    std::vector<std::uint32_t> ends_;    ///< places, two a stroke
    std::vector<double> degrees_;        ///< of strokes, from the first
    std::vector<std::int32_t> followed_; ///< directions of strokes, where they are found one from another
};

namespace {

/// Cuts strokes whose lengths are whole multiples of the shortest; false if some length is none.
bool cut_into_units(const Strokes& strokes, double unit, double tolerance, Strokes& cut) {
    for (const Stroke& stroke : strokes) {
        const double length = stroke_length(stroke) / unit, whole = std::round(length);
        if (std::abs(length - whole) > 2 * tolerance) return false;
        if (static_cast<double>(cut.size()) + whole > most_cut_strokes) return false;
        const Vec2 step = (stroke.to - stroke.from) / whole;
        for (double i = 0; i < whole; ++i)
            cut.push_back({stroke.from + i * step, stroke.from + (i + 1) * step});
    }
    return true;
}

/// The class of each stroke, where lengths are powers of one factor; else nothing.
std::vector<std::uint8_t> power_classes(const Strokes& strokes, double longest, double factor,
                                        double tolerance) {
    std::vector<std::uint8_t> classes;
    for (const Stroke& stroke : strokes) {
        const double power = std::round(std::log(stroke_length(stroke) / longest) / std::log(factor));
        const double expected = longest * std::pow(factor, power);
        if (!(power >= 0 && power < most_length_classes) ||
            std::abs(stroke_length(stroke) - expected) > 3 * tolerance * longest)
            return {};
        classes.push_back(static_cast<std::uint8_t>(power));
    }
    return classes;
}

} // namespace

std::vector<StrokeGraph> stroke_graphs(const Strokes& all, double tolerance, WorkMeter& meter,
                                       std::string& problem) {
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const Stroke& stroke : all)
        for (const Vec2 end : {stroke.from, stroke.to}) {
            low = {std::min(low.x, end.x), std::min(low.y, end.y)};
            high = {std::max(high.x, end.x), std::max(high.y, end.y)};
        }
    const double extent = std::max(high.x - low.x, high.y - low.y);
    Strokes strokes;
    std::vector<double> lengths;
    for (const Stroke& stroke : all)
        if (const double length = stroke_length(stroke); length > 1e-9 * extent) {
            strokes.push_back(stroke);
            lengths.push_back(length);
        }
    if (strokes.size() < 4 || !(extent < 1e100)) {
        problem = extent < 1e100 || strokes.empty()
                      ? fmt::format("it has only {} line{}, too few to tell rules by", strokes.size(),
                                    strokes.size() == 1 ? "" : "s")
                      : "its coordinates are too large";
        return {};
    }
    const double shortest_length = *std::ranges::min_element(lengths);
    const auto groups = value_groups(lengths, tolerance * shortest_length);
    if (groups.size() > most_length_classes) {
        problem = "its lines have too many different lengths";
        return {};
    }
    const double noise_deg = std::min(4.0, std::max(2e-4, 1.2 * tolerance) * 180 / std::numbers::pi);
    std::vector<StrokeGraph> graphs;
    const auto add = [&](const Strokes& read, const std::vector<std::uint8_t>& classes, double unit,
                         double factor) {
        StrokeGraph graph;
        graph.unit = unit;
        graph.factor = factor;
        StrokeGraphBuilder builder(read, tolerance * shortest_length, meter);
        if (builder.build(graph, classes, noise_deg, problem)) graphs.push_back(std::move(graph));
    };
    const double unit = groups.front().first, longest = groups.back().first;
    Strokes cut;
    if (cut_into_units(strokes, unit, tolerance, cut))
        add(cut, std::vector<std::uint8_t>(cut.size()), unit, 1);
    if (groups.size() > 1) {
        const double factor = groups[groups.size() - 2].first / longest;
        const std::vector<std::uint8_t> classes = power_classes(strokes, longest, factor, tolerance);
        if (!classes.empty()) add(strokes, classes, longest, factor);
    }
    if (graphs.empty() && problem.empty())
        problem = "the lengths of its lines are neither multiples of one nor powers of one factor";
    return graphs;
}

} // namespace graftal
