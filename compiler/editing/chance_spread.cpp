#include "compiler/editing/chance_spread.h"

#include <algorithm>
#include <optional>

#include "compiler/lsys/parse/turtle_command.h"

namespace graftal {

namespace {

bool is_chance(const Expression& e) {
    constexpr std::size_t bounds = 2;
    return e.kind == Expression::Kind::call && (e.text == "normal" || e.text == "random") &&
           e.operands.size() == bounds;
}

bool has_chance(const Expression& e) {
    if (is_chance(e)) return true;
    for (const Expression& operand : e.operands)
        if (has_chance(operand)) return true;
    return false;
}

/// The mean, where the numbers of the text say it.
std::optional<double> mean_of(const Expression& e) {
    if (e.kind == Expression::Kind::number) return e.number;
    if (e.kind == Expression::Kind::unary) {
        const std::optional<double> mean = e.text == "-" ? mean_of(e.operands[0]) : std::nullopt;
        return mean ? std::optional(-*mean) : std::nullopt;
    }
    const bool adds = e.kind == Expression::Kind::binary && (e.text == "+" || e.text == "-");
    const bool scales = e.kind == Expression::Kind::binary && (e.text == "*" || e.text == "/");
    if (!adds && !scales && !is_chance(e)) return std::nullopt;
    const std::optional<double> first = mean_of(e.operands[0]);
    if (e.text == "normal") return first;
    if (e.text == "/") return first == 0.0 ? first : std::nullopt;
    const std::optional<double> second = mean_of(e.operands[1]);
    // Draws are independent: the mean of a product is that of the means.
    if (e.text == "*" && (first == 0.0 || second == 0.0)) return 0.0;
    if (!first || !second) return std::nullopt;
    if (e.text == "random") return (*first + *second) / 2;
    if (e.text == "*") return *first * *second;
    return e.text == "+" ? *first + *second : *first - *second;
}

bool is_only_spread(const Expression& e) {
    return has_chance(e) && mean_of(e) == 0.0;
}

/// Numbers and names, each with whether it only spreads chance.
void visit_leaves(const Expression& e, bool only_spreads, const ChanceSpread::Visitor& visitor) {
    if (e.kind == Expression::Kind::number || e.kind == Expression::Kind::name) visitor(e, only_spreads);
    const bool scales = e.kind == Expression::Kind::binary && (e.text == "*" || e.text == "/");
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
        bool spreads = only_spreads;
        if (is_chance(e)) spreads |= e.text == "random" || i == 1;
        if (scales) spreads |= (i == 1 || e.text == "*") && is_only_spread(e.operands[1 - i]);
        visit_leaves(e.operands[i], spreads, visitor);
    }
}

/// Calls `act` for each rule of the file with its block.
template<typename Act> void each_production(const LsysFile& tree, const Act& act) {
    for (const LsysBlock& block : tree.blocks)
        for (const auto* productions : {&block.productions, &block.interpret, &block.decompose})
            for (const LsysProduction& production : *productions)
                act(block, production);
}

/// Calls `act` for the predecessor and each module of the contexts.
template<typename Act> void each_formal(const LsysProduction& production, const Act& act) {
    act(production.predecessor);
    for (const auto* others : {&production.left, &production.following, &production.right})
        for (const LsysFormal& formal : *others)
            act(formal);
}

bool is_turtles(std::string_view symbol) {
    return turtle_command(symbol) != TurtleCommand::none;
}

} // namespace

ChanceSpread::ChanceSpread(const LsysFile& tree) {
    std::vector<Reading> readings;
    each_production(tree, [&](const auto& block, const auto& production) { add_formals(block, production); });
    each_production(
        tree, [&](const auto& block, const auto& production) { add_readings(block, production, readings); });
    std::ranges::sort(readings);
    std::vector<PlaceId> left;
    for (PlaceId place = 0; place < moves_.size(); ++place)
        if (moves_[place]) left.push_back(place);
    while (!left.empty()) {
        const PlaceId made = left.back();
        left.pop_back();
        for (auto reading = std::ranges::lower_bound(readings, Reading{made, 0});
             reading != readings.end() && reading->first == made; ++reading) {
            if (moves_[reading->second]) continue;
            moves_[reading->second] = true;
            left.push_back(reading->second);
        }
    }
}

void ChanceSpread::add_formals(const LsysBlock& block, const LsysProduction& production) {
    each_formal(production, [&](const LsysFormal& formal) {
        for (std::size_t i = 0; i < formal.parameters.size(); ++i) {
            const auto [known, added] =
                ids_.try_emplace({&block, formal.symbol, i}, static_cast<PlaceId>(moves_.size()));
            if (added) moves_.push_back(is_turtles(formal.symbol));
            // Commands hand values on to all rules.
            if (production.before || production.after) moves_[known->second] = true;
        }
    });
}

void ChanceSpread::add_readings(const LsysBlock& block, const LsysProduction& production,
                                std::vector<Reading>& readings) {
    std::map<std::string_view, PlaceId> formals;
    each_formal(production, [&](const LsysFormal& formal) {
        for (std::size_t i = 0; i < formal.parameters.size(); ++i)
            formals.emplace(formal.parameters[i].text, ids_.at({&block, formal.symbol, i}));
    });
    for (const LsysModule& module : production.successor.modules)
        for (std::size_t i = 0; i < module.parameters.size(); ++i) {
            const auto made = ids_.find({&block, module.symbol, i});
            visit_leaves(module.parameters[i], false, [&](const Expression& leaf, bool only_spreads) {
                if (leaf.kind != Expression::Kind::name || only_spreads) return;
                const auto formal = formals.find(leaf.text);
                if (formal == formals.end()) return;
                if (made != ids_.end())
                    readings.emplace_back(made->second, formal->second);
                else if (is_turtles(module.symbol))
                    moves_[formal->second] = true;
            });
        }
}

void ChanceSpread::visit(const LsysBlock& block, const LsysModule& module, const Visitor& visitor) const {
    for (std::size_t i = 0; i < module.parameters.size(); ++i) {
        const auto place = ids_.find({&block, module.symbol, i});
        visit_leaves(module.parameters[i], place != ids_.end() && !moves_[place->second], visitor);
    }
}

} // namespace graftal
