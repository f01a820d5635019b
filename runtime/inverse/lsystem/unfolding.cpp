#include "runtime/inverse/lsystem/unfolding.h"

#include <algorithm>
#include <cstdlib>

namespace graftal {

namespace {

constexpr unsigned most_depth = 3000;     ///< guesses within guesses
constexpr std::uint64_t fit_modules = 4;  ///< that a count of strokes is worth
constexpr std::uint8_t most_brackets = 4; ///< of a rule
constexpr std::uint8_t most_open = 2;     ///< brackets within brackets

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
                                            std::int32_t direction, std::uint64_t most_modules,
                                            unsigned order, const BareRules* known) {
    growth_ = growth;
    order_ = order;
    direction_ = direction;
    modules_ = 0;
    most_modules_ = most_modules;
    gave_up_ = false;
    turns_.assign(2, {});
    turns_[no_turn].known = true;
    rules_.assign(growth.letters + 1, {});
    for (Rule& rule : rules_)
        rule.gaps.emplace_back();
    rules_.back().end_turn = no_turn;
    for (std::size_t rule = growth.straight > 0 ? 1 : 0; known && rule < growth.letters; ++rule)
        lay_down(rule, (*known)[rule]);
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
    if (rule == growth_.letters) return letter == growth_.axiom_letter;
    if (!growth_.by_letter) return is_next(letter);
    return rules_[rule].counts[letter] < growth_.rules[rule][letter];
}

/// Whether the letter was used, or is the first that was not. Others would give the same systems.
bool Unfolding::is_next(std::size_t letter) const {
    if (letter <= growth_.axiom_letter + 1) return true;
    return std::ranges::any_of(rules_, [&](const Rule& rule) { return rule.counts[letter - 1] > 0; });
}

/// Whether the letters that are known leave room for as many strokes as there are.
bool Unfolding::may_fit() {
    if (growth_.by_letter) return true;
    meter_.add(fit_modules);
    modules_ += fit_modules;
    PartialRules known;
    for (std::size_t rule = 0; rule < growth_.letters; ++rule) {
        known[rule].counts = rules_[rule].counts;
        std::size_t drawn = growth_.drawn_in(rule), hidden = growth_.hidden_in(rule);
        for (std::size_t letter = 0; letter < growth_.letters; ++letter)
            (is_hidden(letter) ? hidden : drawn) -= known[rule].counts[letter];
        known[rule].drawn = static_cast<std::uint8_t>(drawn);
        known[rule].hidden = static_cast<std::uint8_t>(hidden);
    }
    const std::uint64_t strokes = graph_.strokes / growth_.axiom;
    const SegmentRange range = segment_range(growth_, known, strokes + 1);
    return range.least <= strokes && strokes <= range.most;
}

/// Whether this order tries guesses at a place of a rule in reverse.
bool Unfolding::is_reversed(const Frame& frame) const {
    const auto place =
        static_cast<std::uint64_t>(frame.rule) * 64 + std::uint64_t{8} * frame.token + frame.item + 1;
    return order_ > 0 &&
           ((order_ * 0x9E3779B97F4A7C15ull ^ place * 0xC2B2AE3D27D4EB4Full) * 0x94D049BB133111EBull >> 63) !=
               0;
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
    if ((item.mark != Mark::letter || may_fit()) && unfold(state)) return true;
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
    const bool may_open =
        !is_open && left > 0 && graph_.branches && !is_axiom(frame.rule) && rule.brackets < most_brackets;
    const bool opens_first = is_reversed(frame);
    if (may_open && opens_first && try_item(state, {Mark::open})) return true;
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
    return may_open && !opens_first && try_item(state, {Mark::open});
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
    const bool may_open = left > 0 && can_draw && graph_.branches && !is_axiom(frame.rule) && !after_open &&
                          rule.open < most_open && rule.brackets < most_brackets;
    const bool opens_first = is_reversed(frame);
    if (may_open && opens_first && try_token(state, {Mark::open})) return true;
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
    return may_open && !opens_first && try_token(state, {Mark::open});
}

bool Unfolding::guess_letter(const State& state) {
    const Frame frame = state.frames.back();
    const auto number = static_cast<std::size_t>(frame.rule);
    for (std::size_t letter = 0; letter < growth_.drawn; ++letter) {
        if (!may_count(number, letter)) continue;
        rules_[number].tokens[frame.token].letter = static_cast<std::int16_t>(letter);
        ++rules_[number].counts[letter];
        if (may_fit() && unfold(state)) return true;
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
            (!taken_.empty() || way.direction == direction_) &&
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
    if (is_reversed(state.frames.back())) std::ranges::reverse(open);
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

} // namespace graftal
