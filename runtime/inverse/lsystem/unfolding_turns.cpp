// The turns of an unfolding, and the words of what it found.

#include "runtime/inverse/lsystem/unfolding.h"

namespace graftal {

namespace {

constexpr std::int32_t most_endless_turn = 6; ///< in angles, where directions never come back

} // namespace

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

/// Makes a rule of known letters and unknown turns. A bracket is a token if a letter in it draws.
void Unfolding::lay_down(std::size_t number, const BareWord& word) {
    Rule& rule = rules_[number];
    bool draws = false;
    for (auto at = word.begin(); at != word.end(); ++at) {
        const Mark mark = *at == bare_open ? Mark::open : *at == bare_close ? Mark::close : Mark::letter;
        const auto letter = static_cast<std::size_t>(static_cast<unsigned char>(*at));
        if (mark == Mark::open)
            draws = std::any_of(at + 1, std::find(at, word.end(), bare_close),
                                [&](std::int8_t next) { return !is_hidden(static_cast<std::size_t>(next)); });
        if (mark == Mark::letter) ++rule.counts[letter];
        if (mark == Mark::letter ? is_hidden(letter) : !draws) {
            rule.hidden += mark == Mark::letter;
            rule.gaps.back().items.push_back({mark, *at, mark == Mark::letter ? new_turn() : no_turn});
            continue;
        }
        const bool is_fixed = mark != Mark::letter || (rule.drawn == 0 && fixes_turn(number));
        rule.drawn += mark == Mark::letter;
        rule.tokens.push_back({mark, *at, is_fixed ? no_turn : new_turn()});
        rule.gaps.emplace_back();
    }
    for (Gap& gap : rule.gaps)
        gap.closed = true;
    rule.complete = true;
    rule.end_turn = new_turn();
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
