// infer_bench SEED FIRST COUNT SECONDS: makes random L-systems of one to four rules, draws each, turns and
// scales the drawing, hands over its segments in random order, and looks whether the system is found again.
// "scene FILE SECONDS": takes the segments of a model. Each gives a line of fields, separated by tabs: name,
// kind, segments, letters of the true rules, letters of the found ones, whether the found system draws the
// same at its depth, and one deeper, processor seconds, the true rules, the found ones.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/lower/plant.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/lsystem/grammar_search.h"
#include "runtime/render/picture_session.h"

namespace graftal {
namespace {

constexpr std::size_t most_letters = 20'000, least_segments = 24;

/// Random numbers that are the same everywhere.
class Dice {
  public:
    /// Seeds that are near give numbers that are not.
    explicit Dice(std::uint64_t seed) : state_(seed ^ 0x1234567) { state_ = next() ^ next() << 1; }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(next() % n); }
    bool one_in(std::size_t n) { return below(n) == 0; }

  private:
    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

/// An L-system as letters: `+` and `-` turn, brackets branch, letters of `drawn` draw.
struct Truth {
    std::string kind;
    double angle_deg = 90;
    std::string axiom, drawn;
    std::map<char, std::string> rules;
    unsigned steps = 3;
};

std::optional<std::string> word_after(const Truth& truth, unsigned steps, std::size_t most) {
    std::string word = truth.axiom;
    for (unsigned i = 0; i < steps; ++i) {
        std::string next;
        for (const char letter : word) {
            const auto rule = truth.rules.find(letter);
            if (rule == truth.rules.end())
                next += letter;
            else
                next += rule->second;
            if (next.size() > most) return std::nullopt;
        }
        word = std::move(next);
    }
    return word;
}

Strokes drawing_of(const Truth& truth, const std::string& word) {
    struct Turtle {
        Vec2 place{0.0};
        double deg = 90;
    };
    Turtle turtle;
    std::vector<Turtle> stack;
    Strokes strokes;
    for (const char letter : word)
        if (letter == '+' || letter == '-') {
            turtle.deg += letter == '+' ? truth.angle_deg : -truth.angle_deg;
        } else if (letter == '[') {
            stack.push_back(turtle);
        } else if (letter == ']') {
            turtle = stack.back();
            stack.pop_back();
        } else if (truth.drawn.find(letter) != std::string::npos) {
            const double radians = turtle.deg * std::numbers::pi / 180;
            const Vec2 from = turtle.place;
            turtle.place += Vec2(std::cos(radians), std::sin(radians));
            strokes.push_back({from, turtle.place});
        }
    return strokes;
}

/// The found system in letters, by the same rules.
Truth as_letters(const FoundGrammar& found, double angle_deg) {
    Truth truth;
    truth.angle_deg = angle_deg;
    const std::string names = "FXYZ", edges = "FGHI";
    const auto letter = [&](std::int32_t number) {
        const auto i = static_cast<std::size_t>(number);
        return i < found.growth.drawn ? edges[i] : names[i + 1 - found.growth.drawn];
    };
    const auto text = [&](const RuleWord& word) {
        std::string all;
        for (const RuleSymbol& symbol : word)
            if (symbol.kind == RuleSymbol::Kind::turn)
                all += std::string(static_cast<std::size_t>(std::abs(symbol.value)),
                                   symbol.value > 0 ? '+' : '-');
            else
                all += symbol.kind == RuleSymbol::Kind::letter ? letter(symbol.value)
                       : symbol.kind == RuleSymbol::Kind::open ? '['
                                                               : ']';
        return all;
    };
    truth.axiom = text(found.axiom);
    for (std::size_t i = 0; i < found.rules.size(); ++i) {
        truth.rules[letter(static_cast<std::int32_t>(i))] = text(found.rules[i]);
        if (i < found.growth.drawn) truth.drawn += letter(static_cast<std::int32_t>(i));
    }
    truth.steps = found.growth.steps;
    return truth;
}

/// Whether two drawings are equal up to a turn and a shift.
class Comparison {
  public:
    explicit Comparison(const Strokes& strokes) : strokes_(strokes), centre_(centre(strokes)) {
        for (std::size_t i = 0; i < strokes.size(); ++i) {
            const Vec2 middle = 0.5 * (strokes[i].from + strokes[i].to) - centre_;
            cells_.emplace(key(std::floor(middle.x * 50), std::floor(middle.y * 50)), i);
        }
    }

    /// The turns that bring the first stroke of the other into a direction of these.
    bool equals(const Strokes& other) const {
        if (other.size() != strokes_.size()) return false;
        const auto deg = [](const Stroke& stroke) {
            return std::atan2(stroke.to.y - stroke.from.y, stroke.to.x - stroke.from.x) * 180 /
                   std::numbers::pi;
        };
        std::map<long, double> turns;
        for (const Stroke& stroke : strokes_)
            turns.emplace(std::lround(100 * deg(stroke)), deg(stroke) - deg(other.front()));
        return std::ranges::any_of(turns,
                                   [&](const auto& turn) { return equals_turned(other, turn.second); });
    }

  private:
    static std::uint64_t key(double x, double y) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)) * 0x9E3779B97F4A7C15ull ^
               static_cast<std::uint64_t>(static_cast<std::int64_t>(y)) * 0xC2B2AE3D27D4EB4Full;
    }
    static Vec2 centre(const Strokes& strokes) {
        Vec2 sum(0.0);
        for (const Stroke& stroke : strokes)
            sum += 0.5 * (stroke.from + stroke.to);
        return sum / static_cast<double>(strokes.size());
    }

    bool equals_turned(const Strokes& other, double deg) const {
        const double c = std::cos(deg * std::numbers::pi / 180), s = std::sin(deg * std::numbers::pi / 180);
        const auto turned = [&](Vec2 p) { return Vec2(c * p.x - s * p.y, s * p.x + c * p.y); };
        const Vec2 middle = centre(other);
        std::vector<bool> used(strokes_.size());
        for (const Stroke& stroke : other) {
            const Vec2 from = turned(stroke.from - middle) + centre_,
                       to = turned(stroke.to - middle) + centre_;
            if (!take(from, to, used)) return false;
        }
        return true;
    }

    bool take(Vec2 from, Vec2 to, std::vector<bool>& used) const {
        const Vec2 p = 0.5 * (from + to) - centre_;
        const auto near = [](Vec2 a, Vec2 b) { return std::hypot(a.x - b.x, a.y - b.y) < 2e-3; };
        for (double x = std::floor(p.x * 50 - 0.2); x <= std::floor(p.x * 50 + 0.2); ++x)
            for (double y = std::floor(p.y * 50 - 0.2); y <= std::floor(p.y * 50 + 0.2); ++y) {
                const auto [first, last] = cells_.equal_range(key(x, y));
                for (auto at = first; at != last; ++at) {
                    const Stroke& stroke = strokes_[at->second];
                    if (used[at->second] || !near(stroke.from, from) || !near(stroke.to, to)) continue;
                    used[at->second] = true;
                    return true;
                }
            }
        return false;
    }

    const Strokes& strokes_;
    Vec2 centre_;
    std::unordered_multimap<std::uint64_t, std::size_t> cells_;
};

std::string random_turn(Dice& dice) {
    if (!dice.one_in(3)) return std::string(dice.one_in(4) ? 2 : 1, "+-"[dice.below(2)]);
    return {};
}

/// A successor of so many letters on its axis, with branches if they are allowed.
std::string random_rule(Dice& dice, const std::string& letters, std::size_t length, bool brackets) {
    std::string word;
    std::size_t branches = 0;
    for (std::size_t i = 0; i < length; ++i) {
        if (brackets && i > 0 && branches < 2 && dice.one_in(2)) {
            ++branches;
            word += std::string("[") + "+-"[dice.below(2)];
            for (std::size_t n = 1 + dice.below(2); n > 0; --n)
                word += letters[dice.below(letters.size())];
            word += "]";
        }
        word += random_turn(dice) + letters[dice.below(letters.size())];
    }
    return dice.one_in(4) ? word + "+-"[dice.below(2)] : word;
}

/// Whether the axiom leads to all letters.
bool uses_all(const Truth& truth) {
    std::string seen = truth.axiom;
    for (std::size_t round = 0; round < truth.rules.size(); ++round)
        for (const auto& [letter, rule] : truth.rules)
            if (seen.find(letter) != std::string::npos) seen += rule;
    return std::ranges::all_of(truth.rules,
                               [&](const auto& rule) { return seen.find(rule.first) != std::string::npos; });
}

Truth random_system(Dice& dice) {
    constexpr double angles[] = {90, 60, 45, 36, 30, 25.7, 22.5, 20, 72, 120};
    const std::size_t rules = 1 + dice.below(4);
    const bool brackets = dice.one_in(2);
    Truth truth;
    truth.angle_deg = angles[dice.below(std::size(angles))];
    const bool nodes = rules == 4 || (rules > 1 && dice.one_in(2));
    truth.kind = std::string(nodes ? "nodes" : "edges") + std::to_string(rules) + (brackets ? "[]" : "");
    if (nodes) {
        truth.drawn = "F";
        truth.rules['F'] = std::string(1 + dice.below(2), 'F');
        const std::string hidden = std::string("XYZ").substr(0, rules - 1);
        for (const char letter : hidden)
            truth.rules[letter] =
                (dice.one_in(2) ? "F" : "") + random_rule(dice, "F" + hidden, 2 + dice.below(3), brackets);
        truth.axiom = "X";
    } else {
        truth.drawn = std::string("ABC").substr(0, rules);
        if (rules == 1) truth.drawn = "F";
        for (const char letter : truth.drawn)
            truth.rules[letter] =
                random_rule(dice, truth.drawn, 2 + dice.below(rules == 1 ? 5 : 3), brackets);
        truth.axiom = truth.drawn.substr(0, 1);
        if (dice.one_in(4)) { // a polygon
            const std::string side = truth.axiom + "+";
            const auto sides = static_cast<std::size_t>(std::lround(360 / truth.angle_deg));
            truth.axiom.clear();
            for (std::size_t i = 0; i < std::min<std::size_t>(sides, 6); ++i)
                truth.axiom += side;
            truth.axiom.pop_back();
        }
    }
    truth.steps = static_cast<unsigned>(3 + dice.below(4));
    return truth;
}

std::size_t letters_of(const Truth& truth) {
    const auto letters = [](const std::string& word) {
        return static_cast<std::size_t>(std::ranges::count_if(word, [](char c) { return std::isalpha(c); }));
    };
    std::size_t sum = letters(truth.axiom);
    for (const auto& rule : truth.rules)
        sum += letters(rule.second);
    return sum;
}

/// A system whose word, and that of one step more, can be drawn, and that grows and turns.
Truth usable_system(Dice& dice) {
    for (;;) {
        Truth truth = random_system(dice);
        if (!uses_all(truth)) continue;
        while (truth.steps >= 3 && !word_after(truth, truth.steps, most_letters))
            --truth.steps;
        if (truth.steps < 3) continue;
        const std::size_t segments = drawing_of(truth, *word_after(truth, truth.steps, most_letters)).size();
        const std::size_t before =
            drawing_of(truth, *word_after(truth, truth.steps - 1, most_letters)).size();
        const bool turns = std::ranges::any_of(truth.rules, [](const auto& rule) {
            return rule.second.find_first_of("+-") != std::string::npos;
        });
        if (segments >= std::max(least_segments, 4 * letters_of(truth)) && segments > before && turns)
            return truth;
    }
}

std::string rules_text(const Truth& truth) {
    std::string text = truth.axiom;
    for (const auto& [letter, rule] : truth.rules)
        text += std::string(" ") + letter + ">" + rule;
    return text + " n" + std::to_string(truth.steps) + " a" + std::to_string(truth.angle_deg).substr(0, 4);
}

/// The outcome of one search, as a line of the table.
struct Outcome {
    std::string name, kind, truth;
    std::size_t segments = 0, letters = 0;
    std::function<std::optional<Strokes>()> deeper; ///< the true drawing after one step more
};

void study(Outcome outcome, Strokes drawn, double seconds, Dice& dice) {
    const Strokes truth = drawn;
    for (std::size_t i = drawn.size(); i > 1; --i)
        std::swap(drawn[i - 1], drawn[dice.below(i)]);
    const double rad = static_cast<double>(dice.below(628)) / 100,
                 size = 1 + static_cast<double>(dice.below(50));
    const double c = size * std::cos(rad), s = size * std::sin(rad);
    for (Stroke& stroke : drawn)
        for (Vec2* end : {&stroke.from, &stroke.to})
            *end = {c * end->x - s * end->y + 17, s * end->x + c * end->y - 5};
    const std::clock_t begun = std::clock();
    StageWork work(seconds);
    Control control;
    control.work = &work;
    std::optional<FoundGrammar> found;
    double angle_deg = 0;
    std::string text;
    try {
        WorkMeter meter(control, "search", 4096, seconds_of_unfolded_module);
        for (const StrokeGraph& graph : stroke_graphs(drawn, 0.01, meter, text)) {
            angle_deg = graph.angle_deg;
            found = find_grammar(graph, meter, {});
            if (found) break;
        }
    } catch (const OutOfWork&) {
        text = "out of work";
    }
    const double taken = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    bool same = false, deeper = false;
    std::size_t letters = 0;
    if (found) {
        const Truth again = as_letters(*found, angle_deg);
        text = rules_text(again);
        letters = letters_of(again);
        const auto word = word_after(again, again.steps, 100 * most_letters);
        same = word && Comparison(truth).equals(drawing_of(again, *word));
        const std::optional<Strokes> next = outcome.deeper();
        // A found rule may be a root of the true one: then one true step is several.
        for (unsigned more = 1; more <= 3 && next && !deeper; ++more) {
            const auto other = word_after(again, again.steps + more, 800 * most_letters);
            if (!other) break;
            deeper = Comparison(*next).equals(drawing_of(again, *other));
        }
    }
    std::printf("%s\t%s\t%zu\t%zu\t%zu\t%d\t%d\t%.2f\t%s\t%s\n", outcome.name.c_str(), outcome.kind.c_str(),
                truth.size(), outcome.letters, letters, same, deeper, taken, outcome.truth.c_str(),
                text.c_str());
    std::fflush(stdout);
}

void study_random(std::uint64_t seed, std::uint64_t number, double seconds) {
    Dice dice(seed * 1'000'003 + number);
    const Truth truth = usable_system(dice);
    const auto deeper = [&]() -> std::optional<Strokes> {
        const auto next = word_after(truth, truth.steps + 1, 400 * most_letters);
        if (!next) return std::nullopt;
        return drawing_of(truth, *next);
    };
    study({std::to_string(number), truth.kind, rules_text(truth), 0, letters_of(truth), deeper},
          drawing_of(truth, *word_after(truth, truth.steps, most_letters)), seconds, dice);
}

/// A scene's segments are all that is handed over.
void study_scene(const std::string& path, double seconds) {
    Dice dice(7);
    unsigned steps = 0;
    const auto drawing = [&](unsigned more) {
        PictureSession session(path);
        StageOptions options;
        options.lower.in_place = LowerOptions::InPlace::plant;
        Compilation compilation;
        if (!more)
            if (const auto lowered = session.lowered(options, compilation); lowered && lowered->notes.plant)
                steps = static_cast<unsigned>(lowered->notes.plant->steps);
        options.lower.steps = steps + more;
        return model_strokes(session, options, compilation);
    };
    std::optional<Strokes> drawn = drawing(0);
    if (!drawn) return static_cast<void>(std::fprintf(stderr, "%s: no drawing\n", path.c_str()));
    const std::string name = path.substr(path.rfind('/') + 1);
    study({name, "scene", "", 0, 0, [&] { return drawing(1); }}, std::move(*drawn), seconds, dice);
}

int run(int argc, char** argv) {
    if (argc == 4 && std::string(argv[1]) == "scene") return study_scene(argv[2], std::atof(argv[3])), 0;
    if (argc != 5)
        return std::fprintf(stderr, "infer_bench SEED FIRST COUNT SECONDS | scene FILE SECONDS\n"), 2;
    const auto seed = static_cast<std::uint64_t>(std::atoll(argv[1])),
               first = static_cast<std::uint64_t>(std::atoll(argv[2])),
               count = static_cast<std::uint64_t>(std::atoll(argv[3]));
    for (std::uint64_t i = first; i < first + count; ++i)
        study_random(seed, i, std::atof(argv[4]));
    return 0;
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    return graftal::run(argc, argv);
}
