#include "compiler/lsys/derive/context.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr std::uint32_t none = ContextLinks::none;
/// More known branches than this are forgotten, at worst to be looked for again.
constexpr std::size_t most_known = 1u << 24;

bool opens(const LsysGrammar& grammar, const LsysPattern& pattern) {
    return grammar.commands[pattern.symbol] == TurtleCommand::open_branch;
}

bool closes(const LsysGrammar& grammar, const LsysPattern& pattern) {
    return grammar.commands[pattern.symbol] == TurtleCommand::close_branch;
}

} // namespace

ContextLinks::ContextLinks(const LsysGrammar& grammar) {
    for (std::size_t symbol = 0; symbol < grammar.symbols.size(); ++symbol) {
        const TurtleCommand command = grammar.commands[symbol];
        roles_.push_back(command == TurtleCommand::open_branch    ? Role::open
                         : command == TurtleCommand::close_branch ? Role::close
                         : grammar.ignored[symbol]                ? Role::ignored
                                                                  : Role::seen);
    }
    for (const LsysRule& rule : grammar.rules) {
        has_left_ |= !rule.left.empty();
        has_right_ |= !rule.right.empty();
        has_branches_ |= std::ranges::any_of(rule.right, [&](const auto& p) { return opens(grammar, p); });
    }
}

void ContextLinks::build(const ModuleTable& modules, std::span<const ModuleId> word) {
    if (has_left_) link_before(modules, word);
    if (has_right_) link_after(modules, word);
}

void ContextLinks::link_before(const ModuleTable& modules, std::span<const ModuleId> word) {
    before_.resize(word.size());
    open_.clear();
    std::uint32_t last = none;
    for (std::uint32_t i = 0; i < word.size(); ++i) {
        before_[i] = last;
        const Role role = roles_[modules.symbol(word[i])];
        if (role == Role::open) {
            open_.push_back(last);
        } else if (role == Role::close) {
            last = open_.back();
            open_.pop_back();
        } else {
            last = role == Role::seen ? i : last;
        }
    }
}

void ContextLinks::link_after(const ModuleTable& modules, std::span<const ModuleId> word) {
    after_.resize(word.size());
    if (has_branches_) {
        branch_.resize(word.size());
        next_branch_.resize(word.size());
    }
    open_.clear();
    std::uint32_t next = none;
    std::uint32_t branch = none;
    for (auto i = static_cast<std::uint32_t>(word.size()); i-- > 0;) {
        after_[i] = next;
        if (has_branches_) branch_[i] = branch;
        const Role role = roles_[modules.symbol(word[i])];
        if (role == Role::close) {
            open_.insert(open_.end(), {next, branch});
            next = branch = none;
        } else if (role == Role::open) {
            if (has_branches_) next_branch_[i] = open_.back();
            next = *(open_.end() - 2);
            open_.resize(open_.size() - 2);
            branch = i;
        } else {
            next = role == Role::seen ? i : next;
            branch = role == Role::seen ? none : branch;
        }
    }
}

ContextMatcher::ContextMatcher(const LsysGrammar& grammar, const ModuleTable& modules)
    : grammar_(grammar), modules_(modules), links_(grammar) {
    for (const LsysRule& rule : grammar.rules)
        right_.push_back(compile(rule.right));
}

ContextMatcher::Range ContextMatcher::compile(const std::vector<LsysPattern>& right) {
    const auto begin = static_cast<std::uint32_t>(items_.size());
    std::vector<std::uint32_t> open;
    for (const LsysPattern& pattern : right) {
        if (opens(grammar_, pattern)) open.push_back(static_cast<std::uint32_t>(items_.size()));
        items_.push_back({pattern.symbol, pattern.arity, 0});
        if (!closes(grammar_, pattern)) continue;
        items_[open.back()].beyond = static_cast<std::uint32_t>(items_.size());
        open.pop_back();
    }
    return {begin, static_cast<std::uint32_t>(items_.size())};
}

void ContextMatcher::look_at(std::span<const ModuleId> word) {
    word_ = word;
    links_.build(modules_, word);
    forget();
}

bool ContextMatcher::matches(const LsysRule& rule, std::uint32_t position, ModuleString& bound) {
    const std::size_t size = bound.size();
    // Many modules of these symbols may see the same branches.
    const LsysPattern& last = rule.following.empty() ? rule.predecessor : rule.following.back();
    remember_ = grammar_.ignored[last.symbol] || opens(grammar_, last) || closes(grammar_, last);
    if (match_following(rule, position, bound) && match_left(rule.left, position, bound) &&
        match_right(right_[static_cast<std::size_t>(&rule - grammar_.rules.data())],
                    position + rule.length() - 1, bound))
        return true;
    bound.resize(size);
    return false;
}

bool ContextMatcher::fits(std::uint32_t position, SymbolId symbol, std::uint16_t arity) const {
    const ModuleId module = word_[position];
    return modules_.symbol(module) == symbol && modules_.parameters(module).size() == arity;
}

bool ContextMatcher::match_following(const LsysRule& rule, std::uint32_t position,
                                     ModuleString& bound) const {
    if (word_.size() - position < rule.length()) return false;
    for (const LsysPattern& pattern : rule.following) {
        if (!fits(++position, pattern.symbol, pattern.arity)) return false;
        bound.push_back(word_[position]);
    }
    return true;
}

bool ContextMatcher::match_left(const std::vector<LsysPattern>& left, std::uint32_t position,
                                ModuleString& bound) const {
    const std::size_t size = bound.size();
    for (auto pattern = left.rbegin(); pattern != left.rend(); ++pattern) {
        position = links_.before(position);
        if (position == none || !fits(position, pattern->symbol, pattern->arity)) return false;
        bound.push_back(word_[position]);
    }
    std::reverse(bound.begin() + static_cast<std::ptrdiff_t>(size), bound.end());
    return true;
}

/// `position`: the predecessor's, or a `[`.
bool ContextMatcher::match_right(Range items, std::uint32_t position, ModuleString& bound) {
    std::uint32_t branch = none; // matched last, since `position`
    for (std::uint32_t at = items.begin; at < items.end;) {
        const Item& item = items_[at];
        if (item.beyond > 0) {
            branch =
                find_branch(at, branch == none ? links_.branch(position) : links_.next_branch(branch), bound);
            if (branch == none) return false;
            at = item.beyond;
        } else {
            position = links_.after(position);
            if (position == none || !fits(position, item.symbol, item.arity)) return false;
            bound.push_back(word_[position]);
            branch = none;
            ++at;
        }
    }
    return true;
}

bool ContextMatcher::begins_so(std::uint32_t item, std::uint32_t branch, ModuleString& bound) {
    const std::size_t size = bound.size();
    if (match_right({item + 1, items_[item].beyond - 1}, branch, bound)) return true;
    bound.resize(size);
    return false;
}

/// The first branch from `from` on that begins as the item and those in its brackets say.
std::uint32_t ContextMatcher::find_branch(std::uint32_t item, std::uint32_t from, ModuleString& bound) {
    std::uint32_t at = from;
    std::uint32_t found = none;
    for (; at != none; at = links_.next_branch(at)) {
        const std::optional<std::uint32_t> known = known_branch(item, at);
        if (!known && !begins_so(item, at, bound)) continue;
        found = known.value_or(at);
        if (known && found != none) begins_so(item, found, bound);
        break;
    }
    if (remember_) remember(item, from, at, found);
    return found;
}

std::optional<std::uint32_t> ContextMatcher::known_branch(std::uint32_t item, std::uint32_t from) const {
    if (!remember_) return std::nullopt;
    const std::uint32_t id = known_ids_.find(mixed(mixed(0, item), from), [&](std::uint32_t other) {
        return known_[other].item == item && known_[other].from == from;
    });
    if (id == IdTable::none) return std::nullopt;
    return known_[id].found;
}

/// Remembers `found` for the branches from `from` on, up to `to`.
void ContextMatcher::remember(std::uint32_t item, std::uint32_t from, std::uint32_t to, std::uint32_t found) {
    if (known_.size() > most_known) forget();
    for (std::uint32_t passed = from; passed != to; passed = links_.next_branch(passed)) {
        known_ids_.add(mixed(mixed(0, item), passed), static_cast<std::uint32_t>(known_.size()));
        known_.push_back({item, passed, found});
    }
}

void ContextMatcher::forget() {
    if (known_.empty()) return;
    known_.clear();
    known_ids_.clear();
}

} // namespace graftal
