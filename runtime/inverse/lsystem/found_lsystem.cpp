#include "runtime/inverse/lsystem/found_lsystem.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/printable.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/lsystem/grammar_search.h"
#include "runtime/inverse/lsystem/place_grid.h"

namespace graftal {

namespace {

constexpr double nearest_place = 0.3; ///< units within which the model's ends of strokes find the drawing's

std::string with_digits(double value, int digits) {
    std::string text;
    append_number(text, value, digits);
    return text;
}

/// Writes the words of a grammar.
class GrammarWriter {
  public:
    GrammarWriter(const FoundGrammar& grammar, const StrokeGraph& graph) : grammar_(grammar), graph_(graph) {}

    std::string text() const {
        const LsysGrowth& growth = grammar_.growth;
        std::string text = "lsys found {\n";
        text += fmt::format("  angle {}\n  steps {}\n  axiom {}{}\n", with_digits(graph_.angle_deg, 12),
                            growth.steps, first_turn(), word(grammar_.axiom, "1", "1"));
        for (std::size_t letter = 0; letter < growth.letters; ++letter) {
            if (letter == 0 && growth.straight == 1) continue;
            text += fmt::format("  {}{} -> {}\n", name(letter), graph_.sized() ? "(s)" : "",
                                word(grammar_.rules[letter], "s", "s*" + with_digits(graph_.factor, 6)));
        }
        if (growth.drawn > 1) {
            text += "  interpret {\n";
            for (std::size_t letter = 0; letter < growth.drawn; ++letter)
                text += fmt::format("    {} -> F\n", name(letter));
            text += "  }\n";
        }
        return text + "}\n";
    }

  private:
    std::string name(std::size_t letter) const {
        const std::size_t drawn = grammar_.growth.drawn;
        if (letter >= drawn) return std::string(1, "XYZW"[letter - drawn]);
        return drawn == 1 ? "F" : std::string(1, "ABCD"[letter]);
    }

    std::string turn(std::int32_t angles) const {
        if (graph_.directions > 0 && 2 * std::abs(angles) == graph_.directions) return "|";
        const char sign = angles > 0 ? '+' : '-';
        if (std::abs(angles) <= 3) return std::string(static_cast<std::size_t>(std::abs(angles)), sign);
        return fmt::format("{}({})", sign, with_digits(std::abs(angles) * graph_.angle_deg, 12));
    }

    /// The turtle heads up at first.
    std::string first_turn() const {
        const double away =
            std::remainder(graph_.first_deg + grammar_.direction * graph_.angle_deg - 90, 360);
        const double angles = away / graph_.angle_deg;
        if (std::abs(away) < 1e-6) return "";
        if (std::abs(angles - std::round(angles)) < 1e-6)
            return turn(static_cast<std::int32_t>(std::lround(angles)));
        return fmt::format("{}({})", away > 0 ? '+' : '-', with_digits(std::abs(away), 9));
    }

    std::string word(const RuleWord& symbols, const std::string& length, const std::string& shorter) const {
        std::string text;
        for (const RuleSymbol& symbol : symbols)
            switch (symbol.kind) {
            case RuleSymbol::Kind::turn:
                text += turn(symbol.value);
                break;
            case RuleSymbol::Kind::open:
                text += '[';
                break;
            case RuleSymbol::Kind::close:
                text += ']';
                break;
            case RuleSymbol::Kind::letter:
                text += name(static_cast<std::size_t>(symbol.value));
                if (graph_.sized()) text += "(" + (symbol.value == 0 ? length : shorter) + ")";
                break;
            }
        return text.empty() ? "*" : text;
    }

    const FoundGrammar& grammar_;
    const StrokeGraph& graph_;
};

/// Looks up the places of a graph.
class PlaceFinder {
  public:
    explicit PlaceFinder(const StrokeGraph& graph) : graph_(graph), cells_(nearest_place * graph.unit) {
        for (std::uint32_t i = 0; i < graph.places.size(); ++i)
            cells_.add(graph.places[i], i);
    }

    /// The place nearest to a point, and how far it is in units; a distance without end if none is near.
    std::pair<std::uint32_t, double> nearest(Vec2 point) const {
        std::pair<std::uint32_t, double> best{0, HUGE_VAL};
        cells_.near(point, [&](std::uint32_t place) {
            const Vec2 away = graph_.places[place] - point;
            const double units = std::hypot(away.x, away.y) / graph_.unit;
            if (units <= nearest_place && units < best.second) best = {place, units};
        });
        return best;
    }

  private:
    const StrokeGraph& graph_;
    PlaceGrid cells_;
};

using Complex = std::complex<double>;

/// A similarity of the plane, by complex numbers.
struct Placement {
    Complex turn, shift;
    Complex operator()(Vec2 p) const { return turn * Complex(p.x, p.y) + shift; }
};

/// The similarity that brings the model's ends of strokes nearest to the drawing's, by least squares; the
/// places that belong together are those that are near each other under the similarity before.
Placement fitted(const Strokes& drawn, const StrokeGraph& graph, const PlaceFinder& finder,
                 Placement placement) {
    Complex from(0), to(0), across(0);
    double square = 0, count = 0;
    for (const Stroke& stroke : drawn) {
        const Complex at = placement(stroke.to);
        const auto [place, away] = finder.nearest({at.real(), at.imag()});
        if (away == HUGE_VAL) continue;
        const Complex p(stroke.to.x, stroke.to.y), q(graph.places[place].x, graph.places[place].y);
        from += p, to += q, across += std::conj(p) * q, square += std::norm(p), count += 1;
    }
    const double spread = square - std::norm(from) / std::max(count, 1.0);
    if (!(spread > 1e-9)) return placement;
    const Complex turn = (across - std::conj(from) * to / count) / spread;
    return {turn, (to - turn * from) / count};
}

/// Compares what the model draws with the drawing.
void compare(const Strokes& drawn, const StrokeGraph& graph, const FoundGrammar& grammar,
             FoundLsystem& found) {
    const PlaceFinder finder(graph);
    std::vector<std::uint32_t> left = graph.copies;
    Placement placement{graph.unit, {graph.places[grammar.start].x, graph.places[grammar.start].y}};
    for (int i = 0; i < 5; ++i)
        placement = fitted(drawn, graph, finder, placement);
    const auto placed = [&](Vec2 point) {
        const Complex at = placement(point);
        return finder.nearest({at.real(), at.imag()});
    };
    for (const Stroke& stroke : drawn) {
        const auto [from, from_away] = placed(stroke.from);
        const auto [to, to_away] = placed(stroke.to);
        if (from_away == HUGE_VAL || to_away == HUGE_VAL) continue;
        for (const StrokeWay& way : graph.ways(from)) {
            if (way.to != to || left[way.bundle] == 0) continue;
            --left[way.bundle];
            ++found.redrawn;
            found.farthest = std::max({found.farthest, from_away, to_away});
            break;
        }
    }
}

std::size_t letters_in(const RuleWord& word) {
    return static_cast<std::size_t>(std::ranges::count(word, RuleSymbol::Kind::letter, &RuleSymbol::kind));
}

/// Redraws a system by the compiler's own derivation and turtle. False after an error.
bool redraw(const FoundGrammar& grammar, const StrokeGraph& graph, FoundLsystem& found,
            Compilation& compilation) {
    found.text = lsystem_text(grammar, graph);
    found.strokes = graph.strokes;
    found.steps = grammar.growth.steps;
    found.angle_deg = graph.angle_deg;
    found.factor = graph.factor;
    found.letters = letters_in(grammar.axiom);
    for (std::size_t letter = 0; letter < grammar.rules.size(); ++letter)
        if (letter > 0 || grammar.growth.straight != 1) found.letters += letters_in(grammar.rules[letter]);
    Compilation own;
    Session session("found.lsys", found.text);
    const std::optional<Strokes> drawn = model_strokes(session, {}, own);
    if (!drawn) {
        compilation.diagnostics.add(own.diagnostics);
        compilation.status = own.status;
        return false;
    }
    compare(*drawn, graph, grammar, found);
    return true;
}

std::string comment_of(const FoundLsystem& found, const FindLsystemOptions& options) {
    const std::string name = escaped(std::filesystem::path(options.drawing).filename().string());
    return fmt::format("# An L-system that graftal found for the drawing {}:\n"
                       "#   {}\n"
                       "# {} letters, turns and brackets left out; it draws {} of {} lines.\n",
                       name, options.made_by, found.letters, found.redrawn, found.strokes);
}

} // namespace

std::string lsystem_text(const FoundGrammar& grammar, const StrokeGraph& graph) {
    return GrammarWriter(grammar, graph).text();
}

std::optional<FoundLsystem> find_lsystem(const FindLsystemOptions& options, const CancelFlag& cancel,
                                         Compilation& compilation) {
    StageWork work(options.seconds);
    const Control control{cancel, {}, &work};
    const std::optional<Strokes> strokes =
        read_drawing(options.drawing, options.compile, {cancel}, compilation);
    if (!strokes) return std::nullopt;
    const auto refuse = [&](std::string problem, const char* hint) {
        compilation.diagnostics.error({}, std::move(problem)).with_hint(hint);
        return std::nullopt;
    };
    try {
        WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
        std::string problem;
        const std::vector<StrokeGraph> graphs = stroke_graphs(*strokes, options.tolerance, meter, problem);
        if (graphs.empty())
            return refuse(
                fmt::format("the drawing '{}' is no L-system's: {}", options.drawing, problem),
                "segments must have one length, or powers of one, and directions that are multiples "
                "of an angle; --tolerance allows more");
        for (const StrokeGraph& graph : graphs) {
            const std::optional<FoundGrammar> grammar = find_grammar(graph, meter, options.on_progress);
            if (!grammar) continue;
            FoundLsystem found;
            if (!redraw(*grammar, graph, found, compilation)) return std::nullopt;
            found.seconds = work.seconds();
            found.text = comment_of(found, options) + found.text;
            return found;
        }
    } catch (const Cancelled&) {
        compilation.status = Status::failure("interrupted");
        return std::nullopt;
    } catch (const OutOfWork&) {
        return refuse(fmt::format("no L-system was found for '{}' in {} s of work", options.drawing,
                                  shortest(options.seconds)),
                      "--work allows more");
    }
    return refuse(fmt::format("no L-system has few letters and draws '{}'", options.drawing),
                  "the drawing must be whole: all lines of some step, each as often as it was drawn");
}

} // namespace graftal
