#include "compiler/import/lpy/ways.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_ways = 64;   ///< through one rule
constexpr int most_decisions = 200;     ///< on one way
constexpr int most_statements = 20'000; ///< statements on all ways

/// Where the colon stands that ends `if condition:`.
std::size_t colon_of(std::string_view text) {
    return std::min(find_outside(text, ":"), text.size());
}

/// The lines of a branch: what stands behind its colon, and what is below.
std::vector<LpyLine> branch_of(const LpyLine& line) {
    std::vector<LpyLine> lines;
    const std::size_t colon = colon_of(line.text);
    const std::string_view behind =
        trimmed(std::string_view(line.text).substr(std::min(colon + 1, line.text.size())));
    if (!behind.empty()) lines.push_back({std::string(behind), "", line.span, line.indent + 1, {}});
    lines.insert(lines.end(), line.below.begin(), line.below.end());
    return lines;
}

int times_named(const std::vector<std::string>& texts, std::string_view name) {
    int times = 0;
    for (const std::string& text : texts)
        names_any(text, [&](std::string_view word) {
            times += word == name ? 1 : 0;
            return false;
        });
    return times;
}

/// `name = value` and `name += value`.
struct Assignment {
    std::string name, sign;
    std::string_view value;
};

std::optional<Assignment> assignment_of(std::string_view text) {
    const std::string_view name = cpfg_name_at(text);
    std::string_view rest = trimmed(text.substr(name.size()));
    if (name.empty()) return std::nullopt;
    std::string sign;
    if (rest.size() > 1 && rest[1] == '=' &&
        std::string_view("+-*/").find(rest[0]) != std::string_view::npos) {
        sign = rest[0];
        rest.remove_prefix(1);
    }
    if (!rest.starts_with('=') || rest.starts_with("==")) return std::nullopt;
    return Assignment{std::string(name), sign, trimmed(rest.substr(1))};
}

} // namespace

std::vector<LpyPath> LpyWays::all(const std::vector<LpyLine>& lines, const LpyValues& values) {
    const Rest rest{&lines, 0, nullptr};
    State state;
    state.path.values = values;
    follow(&rest, std::move(state));
    return std::move(ways_);
}

std::optional<std::string> LpyWays::result(const std::vector<LpyLine>& lines, const LpyValues& values) {
    const std::vector<LpyPath> paths = all(lines, values);
    if (!good_ || paths.empty()) return std::nullopt;
    // Each way but the last asks whether it is the one.
    std::string text;
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
        if (path->produced.size() != 1 || !path->chance.empty()) return std::nullopt;
        if (text.empty()) {
            text = path->produced[0];
            continue;
        }
        std::string condition;
        for (const std::string& one : path->conditions)
            condition += (condition.empty() ? "" : " && ") + one;
        text = fmt::format("choose({}, {}, {})", condition, path->produced[0], text);
    }
    return text;
}

void LpyWays::fail(Span span, const std::string& message) {
    if (good_) python_.complain_(span, message);
    good_ = false;
}

void LpyWays::end(State state) {
    if (state.path.spans.empty()) return; // L-Py goes on with the next rule
    for (const std::string& name : state.once)
        if (times_named(state.path.produced, name) > 1)
            return fail(state.path.spans.back(), "a number of chance is used twice");
    for (const auto& [name, draw] : state.draws) {
        if (draw.low == "0" && draw.high == "1") {
            if (times_named(state.path.produced, name) > 1)
                return fail(state.path.spans.back(), "a number of chance is used twice");
            state.path.values.insert_or_assign(name, "random(0, 1)");
            continue;
        }
        const std::string share = draw.low == "0" ? fmt::format("({})", draw.high)
                                                  : fmt::format("max(0, {} - ({}))", draw.high, draw.low);
        state.path.chance += (state.path.chance.empty() ? "" : "*") + share;
    }
    ways_.push_back(std::move(state.path));
}

void LpyWays::follow(const Rest* rest, State state) {
    const Span span = rest->lines->empty() ? Span() : rest->lines->front().span;
    if (++depth_ > most_decisions || ways_.size() >= most_ways)
        fail(span, "a rule decides between too many cases");
    Rest here{nullptr, 0, nullptr};
    while (good_ && rest) {
        if (rest->at == rest->lines->size()) {
            rest = rest->next;
            continue;
        }
        const LpyLine& line = (*rest->lines)[rest->at];
        if (++steps_ > most_statements) fail(line.span, "a rule decides between too many cases");
        const std::string_view text = line.text, word = cpfg_name_at(text);
        if (word == "if") {
            const Rest now = *rest;
            decide(now, std::move(state));
            --depth_;
            return;
        }
        here = Rest{rest->lines, rest->at + 1, rest->next};
        rest = &here;
        const bool quoted = text.starts_with('"') || text.starts_with('\'');
        if (text.empty() || quoted || word == "pass" || word == "print" || word == "assert") continue;
        if (of_ == Of::rule && (word == "produce" || word == "nproduce")) {
            state.path.produced.emplace_back(trimmed(text.substr(word.size())));
            state.path.spans.push_back(line.span);
            if (word == "produce") break;
        } else if (word == "return") {
            const std::string_view result = trimmed(text.substr(word.size()));
            if (of_ == Of::function && !result.empty()) {
                state.path.produced = {value(result, line.span, state)};
                state.path.spans = {line.span};
            }
            break;
        } else if (word == "for" || word == "while") {
            fail(line.span,
                 fmt::format("'{}' is a loop of Python, which has no translation: below 'decomposition:', a "
                             "module L(i) may produce one turn and L(i + 1) if i < 3",
                             comment_text(text.substr(0, std::min<std::size_t>(colon_of(text), 60)))));
        } else if (!assign(line, state)) {
            fail(line.span, fmt::format("'{}' is Python that has no translation",
                                        comment_text(text.substr(0, word.empty() ? 20 : word.size()))));
        }
    }
    if (good_) end(std::move(state));
    --depth_;
}

/// At an `if`, with the `elif` and `else` behind it.
void LpyWays::decide(const Rest& rest, State state) {
    const std::vector<LpyLine>& lines = *rest.lines;
    std::size_t after = rest.at + 1;
    while (after < lines.size() &&
           (cpfg_name_at(lines[after].text) == "elif" || cpfg_name_at(lines[after].text) == "else"))
        ++after;
    const Rest behind{rest.lines, after, rest.next};
    bool open = true; // no `else` so far
    for (std::size_t at = rest.at; good_ && open && at < after; ++at) {
        const LpyLine& line = lines[at];
        const std::string_view word = cpfg_name_at(line.text);
        const std::vector<LpyLine> branch = branch_of(line);
        const Rest inside{&branch, 0, &behind};
        if (word == "else") {
            open = false;
            return follow(&inside, std::move(state));
        }
        const std::string_view condition =
            std::string_view(line.text).substr(word.size(), colon_of(line.text) - word.size());
        State holds = state;
        ask(condition, line.span, holds, state);
        if (good_) follow(&inside, std::move(holds));
    }
    if (good_) follow(&behind, std::move(state));
}

void LpyWays::ask(std::string_view condition, Span span, State& holds, State& fails) {
    if (ask_chance(condition, span, holds, fails)) return;
    const std::string asked = value(condition, span, holds);
    if (is_random(asked)) return fail(span, "a condition of chance is written 'random() < probability'");
    holds.path.conditions.push_back("(" + asked + ")");
    fails.path.conditions.push_back("!(" + asked + ")");
}

/// `random() <= p`, and `r <= p` with r drawn before: the ways have shares of the numbers from 0 to 1.
bool LpyWays::ask_chance(std::string_view condition, Span span, State& holds, State& fails) {
    condition = trimmed(condition);
    while (condition.starts_with('(') && condition.ends_with(')') &&
           find_outside(condition.substr(1), ")") == condition.size() - 2)
        condition = trimmed(condition.substr(1, condition.size() - 2));
    const std::size_t sign = find_outside(condition, "<>");
    if (sign == std::string_view::npos) return false;
    const std::string_view left = trimmed(condition.substr(0, sign));
    std::string name(left);
    if (!holds.draws.contains(name)) {
        const bool draws = left.ends_with("random()") && std::ranges::all_of(left, [](char c) {
                               return is_cpfg_name(c) || c == '.' || c == '(' || c == ')';
                           });
        if (!draws) return false;
        name = fmt::format(" {}", ++draws_);
    }
    const std::size_t begin = sign + (condition.substr(sign + 1).starts_with('=') ? 2 : 1);
    const std::string bound = value(condition.substr(begin), span, holds);
    if (is_random(bound)) return false;
    const bool below = condition[sign] == '<';
    (below ? holds : fails).draws[name].high = bound;
    (below ? fails : holds).draws[name].low = bound;
    return true;
}

/// A value that chance draws may be used once: in ours each use would draw its own.
std::string LpyWays::value(std::string_view text, Span span, State& state) {
    for (std::size_t i = 0; i < text.size();) {
        if (!is_cpfg_name(text[i])) {
            ++i;
            continue;
        }
        const std::string_view name = cpfg_name_at(text, i);
        i += name.size();
        if (state.draws.contains(name)) fail(span, "a number of chance is used in several ways");
        const auto known = state.path.values.find(name);
        if (known != state.path.values.end() && is_random(known->second)) {
            const auto unused = state.once.find(name);
            if (unused == state.once.end())
                fail(span, "a number of chance is used twice");
            else
                state.once.erase(unused);
        }
    }
    return python_.expression(text, span, state.path.values);
}

bool LpyWays::assign(const LpyLine& line, State& state) {
    const std::optional<Assignment> known = assignment_of(line.text);
    if (!known) return false;
    const std::string& name = known->name;
    const std::string_view given = known->value;
    const bool draws = given.ends_with("random()") &&
                       (given == "random()" || given.find_first_of("+-*/ ") == std::string_view::npos);
    state.draws.erase(name);
    state.once.erase(name);
    if (draws && known->sign.empty()) {
        state.draws[name];
        return true;
    }
    const std::string text =
        known->sign.empty() ? std::string(given) : fmt::format("{} {} ({})", name, known->sign, given);
    std::string own = "(" + value(text, line.span, state) + ")";
    if (is_random(own)) state.once.insert(name);
    state.path.values.insert_or_assign(name, std::move(own));
    return true;
}

} // namespace graftal
