#include "runtime/inverse/lsystem/unfolding.h"

#include <algorithm>
#include <cstdlib>

namespace graftal {

namespace {

constexpr unsigned most_depth = 3000;         ///< guesses within guesses
constexpr std::uint8_t most_brackets = 4;     ///< of a rule
constexpr std::uint8_t most_open = 2;         ///< brackets within brackets
constexpr std::int32_t most_endless_turn = 6; ///< in angles, where directions never come back

} // namespace

Unfolding::Unfolding(const StrokeGraph& graph, WorkMeter& meter)
    : graph_(graph), meter_(meter), left_(graph.copies), leaving_(graph.places.size()),
      coming_(graph.places.size()) {
    for (std::uint32_t place = 0; place < graph.places.size(); ++place)
        for (const StrokeWay& way : graph.ways(place)) {
            leaving_[place] += graph.copies[way.bundle];
            coming_[way.to] += graph.copies[way.bundle];
        }
}

std::optional<FoundGrammar> Unfolding::find(const LsysGrowth& growth, std::uint32_t start,
                                            std::uint64_t most_modules) {
    growth_ = growth;
    modules_ = 0;
    most_modules_ = most_modules;
    gave_up_ = false;
    turns_.assign(2, {});
    turns_[no_turn].known = true;
    rules_.assign(growth.letters + 1, {});
    for (Rule& rule : rules_)
        rule.gaps.emplace_back();
    rules_.back().end_turn = no_turn;
    State state;
    state.frames = {{static_cast<std::int16_t>(growth.letters), static_cast<std::int16_t>(growth.steps + 1)}};
    state.heading.count = 1;
    state.heading.terms[0] = {first_turn, 1};
    state.place = start;
    const bool found = unfold(std::move(state));
    std::optional<FoundGrammar> grammar;
    if (found) {
        grammar = FoundGrammar{growth, word_of(rules_.back()), {}, start, value(first_turn)};
        for (std::size_t letter = 0; letter < growth.letters; ++letter) {
            grammar->rules.push_back(word_of(rules_[letter]));
            if (letter == 0 && growth.straight > 0) grammar->rules.back().assign(growth.straight, {});
        }
    }
    restore(0);
    return grammar;
}

/// Whether the system draws all, with some guesses from here on; else takes back what was drawn.
bool Unfolding::unfold(State state) {
    if (depth_ == most_depth) return false;
    const std::size_t before = taken_.size();
    ++depth_;
    const bool found = follow(state);
    --depth_;
    if (!found) restore(before);
    return found;
}

/// Follows the word until a guess is due.
bool Unfolding::follow(State& state) {
    for (;;) {
        meter_.add();
        if (++modules_ > most_modules_) {
            gave_up_ = true;
            return false;
        }
        if (state.run > 0) {
            bool ended = false;
            const bool found = draw(state, ended);
            if (ended) return found;
            continue;
        }
        Frame& frame = state.frames.back();
        const Rule& rule = rules_[frame.rule];
        if (frame.level >= 2 && has_hidden()) {
            const Gap& gap = rule.gaps[frame.token];
            if (frame.item < gap.items.size()) {
                if (!meet_item(state, gap.items[frame.item])) return false;
                continue;
            }
            if (!gap.closed) return guess_item(state);
        }
        if (frame.token < rule.tokens.size()) {
            const Token& token = rule.tokens[frame.token];
            if (token.mark == Mark::letter && token.letter == any_letter && frame.level >= 2)
                return guess_letter(state);
            if (!meet_token(state)) return false;
        } else if (!rule.complete) {
            return guess_token(state);
        } else if (finish_rule(state)) {
            return taken_.size() == graph_.strokes;
        }
    }
}

/// False if the branch that ends here leaves strokes behind.
bool Unfolding::meet_item(State& state, const Item& item) {
    Frame& frame = state.frames.back();
    ++frame.item;
    if (item.mark == Mark::open) {
        state.branches.push_back({state.place, state.heading});
    } else if (item.mark == Mark::close) {
        return close_branch(state);
    } else {
        turn_by(state.heading, item.turn, 1);
        const auto level = static_cast<std::int16_t>(frame.level - 1);
        state.frames.push_back({item.letter, level});
    }
    return true;
}

/// False if the branch that ends here leaves strokes behind. Requires a letter where one is due.
bool Unfolding::meet_token(State& state) {
    Frame& frame = state.frames.back();
    const Rule& rule = rules_[frame.rule];
    const Token token = rule.tokens[frame.token];
    turn_after_gap(state, frame, rule, token.turn);
    ++frame.token;
    frame.item = 0;
    if (token.mark == Mark::open) {
        state.branches.push_back({state.place, state.heading});
    } else if (token.mark == Mark::close) {
        return close_branch(state);
    } else if (frame.level == 1 || (token.letter == 0 && growth_.straight > 0)) {
        state.run = 1;
        for (int level = frame.level; level > 1; --level)
            state.run *= growth_.straight;
        if (graph_.sized())
            state.length = static_cast<std::uint8_t>(static_cast<int>(growth_.steps) - frame.level);
    } else {
        const auto level = static_cast<std::int16_t>(frame.level - 1);
        state.frames.push_back({token.letter, level});
    }
    return true;
}

/// True at the end of the word.
bool Unfolding::finish_rule(State& state) {
    const Frame frame = state.frames.back();
    const Rule& rule = rules_[frame.rule];
    turn_after_gap(state, frame, rule, rule.end_turn);
    state.frames.pop_back();
    return state.frames.empty();
}

/// A token's turn is from the token before, and holds what turns the items between took.
void Unfolding::turn_after_gap(State& state, const Frame& frame, const Rule& rule, Number turn) const {
    turn_by(state.heading, turn, 1);
    if (frame.level < 2 || !has_hidden()) return;
    int depth = 0;
    for (const Item& item : rule.gaps[frame.token].items) {
        depth += item.mark == Mark::open ? 1 : item.mark == Mark::close ? -1 : 0;
        if (item.mark == Mark::letter && depth == 0) turn_by(state.heading, item.turn, -1);
    }
}

bool Unfolding::may_count(std::size_t rule, std::size_t letter) const {
    if (rule == growth_.letters) return !growth_.by_letter || letter == growth_.axiom_letter;
    return !growth_.by_letter || rules_[rule].counts[letter] < growth_.rules[rule][letter];
}

/// Whether the first turn of a rule may be chosen: another choice gives the same drawings.
bool Unfolding::fixes_turn(std::size_t rule) const {
    if (rule == growth_.letters || is_hidden(rule)) return true;
    for (std::size_t other = 0; other < growth_.drawn; ++other)
        if (rules_[other].drawn > 0) return false;
    return growth_.straight == 0;
}

bool Unfolding::try_item(const State& state, const Item& item) {
    const Frame frame = state.frames.back();
    Rule& rule = rules_[frame.rule];
    Gap& gap = rule.gaps[frame.token];
    gap.items.push_back(item);
    const int opened = item.mark == Mark::open ? 1 : item.mark == Mark::close ? -1 : 0;
    gap.open = static_cast<std::uint8_t>(gap.open + opened);
    if (opened > 0) ++rule.brackets;
    if (item.mark == Mark::letter) {
        ++rule.hidden;
        ++rule.counts[static_cast<std::size_t>(item.letter)];
    }
    if (unfold(state)) return true;
    Rule& again = rules_[frame.rule];
    Gap& gap_again = again.gaps[frame.token];
    if (item.mark == Mark::letter) {
        --again.hidden;
        --again.counts[static_cast<std::size_t>(item.letter)];
    }
    if (opened > 0) --again.brackets;
    gap_again.open = static_cast<std::uint8_t>(gap_again.open - opened);
    gap_again.items.pop_back();
    return false;
}

bool Unfolding::guess_item(const State& state) {
    const Frame frame = state.frames.back();
    const auto number = static_cast<std::size_t>(frame.rule);
    const Rule& rule = rules_[number];
    const Gap& gap = rule.gaps[frame.token]; // only until the first guess: gaps move
    const std::size_t left = growth_.hidden_in(number) - rule.hidden;
    const bool at_end = rule.complete && frame.token == rule.tokens.size();
    const bool is_open = gap.open > 0;
    const bool after_open = is_open && gap.items.back().mark == Mark::open;
    if (left > 0) {
        const bool is_first = is_axiom(frame.rule) && rule.hidden == 0;
        const Number turn = is_first ? no_turn : new_turn();
        for (std::size_t letter = growth_.drawn; letter < growth_.letters; ++letter)
            if (may_count(number, letter) && (!is_first || letter == growth_.axiom_letter) &&
                try_item(state, {Mark::letter, static_cast<std::int16_t>(letter), turn}))
                return true;
        if (!is_first) turns_.pop_back();
    }
    if (is_open) return !after_open && try_item(state, {Mark::close});
    if (!at_end || left == 0) {
        rules_[number].gaps[frame.token].closed = true;
        if (unfold(state)) return true;
        rules_[number].gaps[frame.token].closed = false;
    }
    return left > 0 && graph_.branches && !is_axiom(frame.rule) && rule.brackets < most_brackets &&
           try_item(state, {Mark::open});
}

bool Unfolding::try_token(const State& state, const Token& token) {
    const auto number = static_cast<std::size_t>(state.frames.back().rule);
    const int opened = token.mark == Mark::open ? 1 : token.mark == Mark::close ? -1 : 0;
    const auto change = [&](int sign) {
        Rule& rule = rules_[number];
        rule.open = static_cast<std::uint8_t>(rule.open + sign * opened);
        if (opened > 0) rule.brackets = static_cast<std::uint8_t>(rule.brackets + sign);
        if (token.mark != Mark::letter) return;
        rule.drawn = static_cast<std::uint8_t>(rule.drawn + sign);
        if (token.letter == any_letter) return;
        std::uint8_t& count = rule.counts[static_cast<std::size_t>(token.letter)];
        count = static_cast<std::uint8_t>(count + sign);
    };
    rules_[number].tokens.push_back(token);
    rules_[number].gaps.emplace_back();
    change(1);
    if (unfold(state)) return true;
    change(-1);
    rules_[number].gaps.pop_back();
    rules_[number].tokens.pop_back();
    return false;
}

bool Unfolding::guess_token(const State& state) {
    const Frame frame = state.frames.back();
    const auto number = static_cast<std::size_t>(frame.rule);
    const Rule& rule = rules_[number];
    const std::size_t left = growth_.drawn_in(number) - rule.drawn;
    const bool after_open = !rule.tokens.empty() && rule.tokens.back().mark == Mark::open;
    const bool after_close = !rule.tokens.empty() && rule.tokens.back().mark == Mark::close;
    const bool draws_now = frame.level == 1;
    const bool can_draw =
        !draws_now || std::ranges::any_of(graph_.ways(state.place),
                                          [&](const StrokeWay& way) { return left_[way.bundle] > 0; });
    if (left > 0 && can_draw) {
        const bool is_fixed = rule.drawn == 0 && fixes_turn(number);
        const Number turn = is_fixed ? no_turn : new_turn();
        std::int16_t letter = growth_.drawn == 1 ? std::int16_t{0} : any_letter;
        if (is_axiom(frame.rule) && rule.drawn == 0) letter = static_cast<std::int16_t>(growth_.axiom_letter);
        if (try_token(state, {Mark::letter, letter, turn})) return true;
        if (!is_fixed) turns_.pop_back();
    }
    if (rule.open > 0) {
        // A branch at the end of a branch goes on along it.
        if (!after_open && (has_hidden() || !after_close) && try_token(state, {Mark::close})) return true;
    } else if (left == 0 && (frame.level == 1 || rule.hidden == growth_.hidden_in(number))) {
        rules_[number].complete = true;
        rules_[number].end_turn = is_axiom(frame.rule) ? no_turn : new_turn();
        if (unfold(state)) return true;
        if (!is_axiom(frame.rule)) turns_.pop_back();
        rules_[number].complete = false;
    }
    return left > 0 && can_draw && graph_.branches && !is_axiom(frame.rule) && !after_open &&
           rule.open < most_open && rule.brackets < most_brackets && try_token(state, {Mark::open});
}

bool Unfolding::guess_letter(const State& state) {
    const Frame frame = state.frames.back();
    const auto number = static_cast<std::size_t>(frame.rule);
    for (std::size_t letter = 0; letter < growth_.drawn; ++letter) {
        if (!may_count(number, letter)) continue;
        rules_[number].tokens[frame.token].letter = static_cast<std::int16_t>(letter);
        ++rules_[number].counts[letter];
        if (unfold(state)) return true;
        --rules_[number].counts[letter];
    }
    rules_[number].tokens[frame.token].letter = any_letter;
    return false;
}

/// Draws one stroke; or ends with the result of guesses.
bool Unfolding::draw(State& state, bool& ended) {
    settle(state.heading);
    if (state.heading.count > 0 || state.heading.lost) {
        ended = true;
        return !state.heading.lost && guess_turn(state);
    }
    const std::int32_t direction = reduced(state.heading.known);
    const StrokeWay* only = nullptr;
    std::vector<std::uint32_t> others;
    const std::span<const StrokeWay> ways = graph_.ways(state.place);
    for (std::uint32_t i = 0; i < ways.size(); ++i) {
        if (ways[i].direction != direction || left_[ways[i].bundle] == 0 ||
            graph_.classes[ways[i].bundle] != state.length)
            continue;
        if (only) others.push_back(i);
        if (!only) only = &ways[i];
    }
    ended = !only || !others.empty();
    if (!only) return false;
    if (ended) {
        if (try_way(state, *only)) return true;
        return std::ranges::any_of(others, [&](std::uint32_t i) { return try_way(state, ways[i]); });
    }
    ended = !take(state, *only);
    return false;
}

/// Goes along a stroke; false if strokes stay behind at a place that no way leads to any more.
bool Unfolding::take(State& state, const StrokeWay& way) {
    const std::uint32_t from = state.place;
    --left_[way.bundle];
    --leaving_[from];
    --coming_[way.to];
    taken_.push_back({way.bundle, from, way.to});
    state.place = way.to;
    --state.run;
    return !strands(state, from);
}

/// Whether strokes are left at a place that the turtle has gone from and cannot come back to.
bool Unfolding::strands(const State& state, std::uint32_t place) const {
    return leaving_[place] > 0 && coming_[place] == 0 && state.place != place &&
           std::ranges::none_of(state.branches, [&](const Branch& branch) { return branch.place == place; });
}

/// False if strokes stay behind in the branch.
bool Unfolding::close_branch(State& state) const {
    const std::uint32_t from = state.place;
    state.place = state.branches.back().place;
    state.heading = state.branches.back().heading;
    state.branches.pop_back();
    return !strands(state, from);
}

bool Unfolding::try_way(const State& state, const StrokeWay& way) {
    const std::size_t before = taken_.size();
    State next = state;
    if (take(next, way) && unfold(std::move(next))) return true;
    restore(before);
    return false;
}

void Unfolding::restore(std::size_t taken) {
    for (; taken_.size() > taken; taken_.pop_back()) {
        ++left_[taken_.back().bundle];
        ++leaving_[taken_.back().from];
        ++coming_[taken_.back().to];
    }
}

bool Unfolding::try_turn(const State& state, Number turn, const Heading& value) {
    turns_[turn] = {true, value};
    if (unfold(state)) return true;
    turns_[turn].known = false;
    return false;
}

/// Gives the unknown turns of the heading such values that there is a stroke ahead. One of several is put as
/// the sum that the others leave for it.
bool Unfolding::guess_turn(const State& state) {
    const Heading& heading = state.heading;
    std::vector<std::int32_t> open;
    for (const StrokeWay& way : graph_.ways(state.place))
        if (left_[way.bundle] > 0 && graph_.classes[way.bundle] == state.length &&
            (open.empty() || open.back() != way.direction))
            open.push_back(way.direction);
    std::uint8_t chosen = 0;
    while (chosen < heading.count && std::abs(heading.terms[chosen].factor) != 1)
        ++chosen;
    if (chosen == heading.count) return guess_multiple(state, open);
    const auto [turn, factor] = heading.terms[chosen];
    Heading rest; // what the turn leaves
    for (std::uint8_t i = 0; i < heading.count; ++i)
        if (i != chosen)
            rest.terms[rest.count++] = {heading.terms[i].turn, -factor * heading.terms[i].factor};
    for (std::int32_t& direction : open)
        direction = reduced(factor * (direction - heading.known));
    std::ranges::sort(open, {}, [](std::int32_t x) { return std::pair(std::abs(x), -x); });
    return std::ranges::any_of(open, [&, number = turn](std::int32_t guess) {
        rest.known = guess;
        return try_turn(state, number, rest);
    });
}

/// Does so where the first unknown turn counts several times.
bool Unfolding::guess_multiple(const State& state, const std::vector<std::int32_t>& open) {
    const auto [turn, factor] = state.heading.terms[0];
    return std::ranges::any_of(turns_in_order(), [&, number = turn, times = factor](std::int32_t guess) {
        const std::int32_t direction = reduced(state.heading.known + times * guess);
        if (state.heading.count == 1 && std::ranges::find(open, direction) == open.end()) return false;
        return try_turn(state, number, {guess});
    });
}

/// Turns from the smallest on.
std::vector<std::int32_t> Unfolding::turns_in_order() const {
    std::vector<std::int32_t> turns = {0};
    const std::int32_t most = graph_.directions > 0 ? graph_.directions / 2 : most_endless_turn;
    for (std::int32_t turn = 1; turn <= most; ++turn) {
        turns.push_back(turn);
        if (2 * turn != graph_.directions) turns.push_back(-turn);
    }
    return turns;
}

/// A direction, or a turn, between minus half a circle and half a circle.
std::int32_t Unfolding::reduced(std::int32_t direction) const {
    const std::int32_t circle = graph_.directions;
    if (circle == 0) return direction;
    direction %= circle;
    if (2 * direction > circle) direction -= circle;
    if (2 * direction <= -circle) direction += circle;
    return direction;
}

Unfolding::Number Unfolding::new_turn() {
    turns_.emplace_back();
    return static_cast<Number>(turns_.size() - 1);
}

void Unfolding::turn_by(Heading& heading, Number turn, std::int32_t factor) const {
    if (turns_[turn].known) {
        const Heading& value = turns_[turn].value;
        heading.known = reduced(heading.known + factor * value.known);
        heading.lost = heading.lost || value.lost;
        for (std::uint8_t i = 0; i < value.count; ++i)
            turn_by(heading, value.terms[i].turn, factor * value.terms[i].factor);
        return;
    }
    for (std::uint8_t i = 0; i < heading.count; ++i) {
        Heading::Term& term = heading.terms[i];
        if (term.turn != turn) continue;
        term.factor = reduced(term.factor + factor);
        if (term.factor == 0) term = heading.terms[--heading.count];
        return;
    }
    if (heading.count == heading.terms.size())
        heading.lost = true;
    else
        heading.terms[heading.count++] = {turn, reduced(factor)};
}

/// Puts values in place of turns that have become known.
void Unfolding::settle(Heading& heading) const {
    const bool settled = std::none_of(heading.terms.begin(), heading.terms.begin() + heading.count,
                                      [&](const Heading::Term& term) { return turns_[term.turn].known; });
    if (settled) return;
    const Heading before = heading;
    heading.count = 0;
    for (std::uint8_t i = 0; i < before.count; ++i)
        turn_by(heading, before.terms[i].turn, before.terms[i].factor);
}

/// The value of a turn, where those that are unknown to the end are none.
std::int32_t Unfolding::value(Number turn) const {
    Heading heading;
    turn_by(heading, turn, 1);
    return heading.known;
}

void Unfolding::add_turn(RuleWord& word, std::int32_t turn) const {
    if (reduced(turn) != 0) word.push_back({RuleSymbol::Kind::turn, reduced(turn)});
}

RuleWord Unfolding::word_of(const Rule& rule) const {
    using Kind = RuleSymbol::Kind;
    constexpr Kind brackets[] = {Kind::letter, Kind::open, Kind::close};
    RuleWord word;
    for (std::size_t i = 0; i <= rule.tokens.size(); ++i) {
        std::int32_t passed = 0;
        int depth = 0;
        for (const Item& item : rule.gaps[i].items) {
            depth += item.mark == Mark::open ? 1 : item.mark == Mark::close ? -1 : 0;
            if (item.mark == Mark::letter) {
                add_turn(word, value(item.turn));
                passed += depth == 0 ? value(item.turn) : 0;
            }
            word.push_back({brackets[static_cast<std::size_t>(item.mark)], item.letter});
        }
        const bool at_end = i == rule.tokens.size();
        const bool closes = !at_end && rule.tokens[i].mark == Mark::close;
        if (!closes) add_turn(word, value(at_end ? rule.end_turn : rule.tokens[i].turn) - passed);
        if (at_end) break;
        const Token& token = rule.tokens[i];
        const std::int32_t letter = token.letter == any_letter ? 0 : token.letter;
        word.push_back(
            {brackets[static_cast<std::size_t>(token.mark)], token.mark == Mark::letter ? letter : 0});
    }
    return word;
}

} // namespace graftal
