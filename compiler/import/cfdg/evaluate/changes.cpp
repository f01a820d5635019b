// Adjustments as numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/evaluate/evaluator.h"

namespace graftal::cfdg {

namespace {

constexpr std::array<std::string_view, 8> geometric_words = {"x", "y", "z", "r", "s", "skew", "f", "trans"};
constexpr std::size_t most_colour_steps = 10'000;

double tangent(double degrees) {
    return std::tan(degrees * std::numbers::pi / 180);
}

Affine scaled_by(double x, double y, double z) {
    return Affine::scale({x, y, z});
}

} // namespace

std::string_view primitive_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> table = {
        {{"CIRCLE", "CIRCLE"},
         {"SQUARE", "SQUARE"},
         {"TRIANGLE", "TRIANGLE"},
         {"\u25cf", "CIRCLE"},
         {"\u26ab", "CIRCLE"},
         {"\u2b24", "CIRCLE"},
         {"\u25a0", "SQUARE"},
         {"\u25fc", "SQUARE"},
         {"\u2b1b", "SQUARE"},
         {"\uffed", "SQUARE"},
         {"\u25b2", "TRIANGLE"},
         {"\u25b4", "TRIANGLE"}}};
    for (const auto& [written, meant] : table)
        if (name == written) return meant;
    return {};
}

bool is_of_paths(std::string_view word) {
    static constexpr std::array<std::string_view, 8> words = {"p",  "width", "x1", "y1",
                                                              "x2", "y2",    "rx", "ry"};
    return std::ranges::find(words, word) != words.end();
}

std::optional<Channel> channel_of(const Adjustment& adjustment) {
    if (adjustment.word == "h") return Channel::hue;
    if (adjustment.word == "sat") return Channel::saturation;
    if (adjustment.word == "b") return Channel::brightness;
    if (adjustment.word == "a") return Channel::alpha;
    return std::nullopt;
}

std::vector<const Adjustment*> in_order(const Modification& modification) {
    std::vector<const Adjustment*> all;
    if (modification.ordered) {
        for (const Adjustment& adjustment : modification.adjustments)
            all.push_back(&adjustment);
        return all;
    }
    all = last_of_each(modification, geometric_words);
    for (const Adjustment& adjustment : modification.adjustments)
        if (std::ranges::find(geometric_words, adjustment.word) == geometric_words.end())
            all.push_back(&adjustment);
    return all;
}

std::optional<LoopBounds> Evaluator::bounds(const Element& loop, const Surroundings& at) {
    std::vector<double> n;
    for (const Expr& bound : loop.arguments) {
        const std::optional<std::vector<double>> one = numbers(bound, at);
        if (!one) return std::nullopt;
        n.insert(n.end(), one->begin(), one->end());
    }
    if (n.empty() || n.size() > 3) return fail(loop.span, "a loop has one to three bounds");
    const LoopBounds bounds{n.size() > 1 ? n[0] : 0, n.size() > 1 ? n[1] : n[0], n.size() > 2 ? n[2] : 1};
    if (bounds.step == 0) return fail(loop.span, "the step of a loop must not be 0");
    return bounds;
}

const Elements* Evaluator::choice(const Element& element, const Surroundings& at) {
    const std::optional<double> value = number(element.arguments[0], at);
    if (!value) return nullptr;
    const double chosen = std::floor(*value);
    const Elements* otherwise = nullptr;
    for (const Case& one : element.cases) {
        if (one.values.empty()) otherwise = &one.body;
        for (const Expr& label : one.values) {
            const bool range = label.kind == Expr::Kind::binary && label.text == "..";
            const std::optional<double> from = number(range ? label.operands[0] : label, at);
            const std::optional<double> to = range ? number(label.operands[1], at) : from;
            if (!from || !to) return nullptr;
            if (chosen >= std::floor(*from) && chosen <= std::floor(*to)) return &one.body;
        }
    }
    return otherwise;
}

std::optional<Change> Evaluator::change(const Modification& modification, const Surroundings& at) {
    Change made;
    for (const Adjustment* const adjustment : in_order(modification)) {
        if (!spend(adjustment->span)) return std::nullopt;
        const std::string& word = adjustment->word;
        if (is_of_paths(word)) continue;
        if (word == "time" || word == "timescale") {
            note(adjustment->span, fmt::format("'{}' changes nothing here", word));
            continue;
        }
        std::vector<double> n;
        std::string flags;
        bool whole = false;
        for (const Expr& expression : adjustment->values) {
            std::optional<Value> one = value(expression, at);
            if (!one) return std::nullopt;
            if (one->kind == Value::Kind::shape) return fail(expression.span, "this is no number");
            if (one->kind == Value::Kind::change) {
                if (word != "trans") return fail(expression.span, fmt::format("'{}' takes numbers", word));
                made.add(one->change);
                whole = true;
                continue;
            }
            n.insert(n.end(), one->numbers.begin(), one->numbers.end());
            flags += one->flags;
        }
        if (whole) continue;
        if (word == "blend") {
            if (flags != "CF::Normal")
                return fail(adjustment->span, fmt::format("'blend {}' is not translated", flags));
            continue;
        }
        if (n.empty() || !std::ranges::all_of(n, [](double one) { return std::abs(one) < 1e50; }))
            return fail(adjustment->span, fmt::format("'{}' takes other numbers", word));
        if (channel_of(*adjustment)) {
            if (!colour(*adjustment, n, made.colours)) return std::nullopt;
            continue;
        }
        const std::optional<Affine> step = move(*adjustment, n);
        if (!step) return std::nullopt;
        made.map = made.map * *step;
    }
    if (made.colours.size() > most_colour_steps)
        return fail(modification.span, "this changes the colour too often");
    // A target changes behind the colours that go to it.
    std::stable_partition(made.colours.begin(), made.colours.end(),
                          [](const ColourStep& step) { return step.kind != ColourStep::Kind::target; });
    return made;
}

std::optional<Affine> Evaluator::move(const Adjustment& adjustment, const std::vector<double>& n) {
    const std::string& word = adjustment.word;
    const std::size_t count = n.size();
    const double second = count > 1 ? n[1] : 0, third = count > 2 ? n[2] : 0;
    if (word == "x" && count <= 3) return Affine::translate({n[0], second, third});
    if (word == "y" && count <= 2) return Affine::translate({0, n[0], second});
    if (word == "z" && count == 1) return Affine::translate({0, 0, n[0]});
    if (word == "r" && count == 1) return Affine::rotate({0, 0, 1}, n[0]);
    if (word == "s" && count <= 3) {
        return scaled_by(n[0], count > 1 ? n[1] : n[0], count > 2 ? third : 1);
    }
    if (word == "skew" && count <= 2) {
        Affine step;
        step.linear[1][0] = tangent(n[0]);
        step.linear[0][1] = tangent(second);
        return step;
    }
    if (word == "f" && count == 1)
        return Affine::rotate({0, 0, 1}, n[0]) * scaled_by(1, -1, 1) * Affine::rotate({0, 0, 1}, -n[0]);
    if (word == "trans" && count <= 2) return Affine::translate({n[0], second, 0});
    if (word == "trans" && count == 4) { // the unit line to this one
        const double x = n[2] - n[0], y = n[3] - n[1], length = std::hypot(x, y);
        return Affine::translate({n[0], n[1], 0}) *
               Affine::rotate({0, 0, 1}, std::atan2(y, x) * 180 / std::numbers::pi) *
               scaled_by(length, length, 1);
    }
    if (word == "trans" && count == 6) { // the unit square's corners (0, 0), (1, 0) and (1, 1) to these
        Affine step = Affine::translate({n[0], n[1], 0});
        step.linear[0] = {n[2] - n[0], n[3] - n[1], 0};
        step.linear[1] = {n[4] - n[2], n[5] - n[3], 0};
        return step;
    }
    return fail(adjustment.span, fmt::format("'{}' is not translated with {} numbers", word, count));
}

bool Evaluator::colour(const Adjustment& adjustment, const std::vector<double>& n,
                       std::vector<ColourStep>& steps) {
    using Kind = ColourStep::Kind;
    const Channel channel = *channel_of(adjustment);
    const auto share = [](double number) { return std::clamp(number, -1.0, 1.0); };
    const auto amount = [&](Channel of, double number) {
        return of == Channel::hue ? number : share(number);
    };
    const bool target = adjustment.sets_target || adjustment.to_target;
    if (n.size() > (target ? 1 : channel == Channel::hue ? 4 : 2)) {
        fail(adjustment.span,
             fmt::format("'{}' is not translated with {} numbers", adjustment.word, n.size()));
        return false;
    }
    if (adjustment.to_target)
        steps.push_back({Kind::toward_target, channel, share(n[0])});
    else if (adjustment.sets_target)
        steps.push_back({Kind::target, channel, amount(channel, n[0])});
    else if (n.size() == 2)
        steps.push_back({Kind::toward, channel, share(n[0]),
                         channel == Channel::hue ? n[1] : std::clamp(n[1], 0.0, 1.0)});
    else
        for (std::size_t i = 0; i < n.size(); ++i) {
            const auto of = static_cast<Channel>(static_cast<std::size_t>(channel) + i);
            steps.push_back({Kind::change, of, amount(of, n[i])});
        }
    return true;
}

} // namespace graftal::cfdg
