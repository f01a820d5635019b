#include "compiler/lsys/walk/plant_tally.h"

#include <algorithm>
#include <utility>

namespace graftal {

namespace {

/// Most sums of all parts; each takes about 250 bytes.
constexpr std::size_t most_sums = 1'000'000;
/// Most additions of the sums of one part to those of another: some ten seconds.
constexpr std::size_t most_additions = 50'000'000;

} // namespace

std::uint16_t number_of_material(std::vector<std::string>& materials, std::string_view name) {
    const auto known = std::ranges::find(materials, name);
    const auto number = static_cast<std::uint16_t>(known - materials.begin());
    if (known == materials.end()) materials.emplace_back(name);
    return number;
}

bool is_plant_part(TurtleCommand command) {
    switch (command) {
    case TurtleCommand::none:
    case TurtleCommand::draw:
    case TurtleCommand::draw_always:
    case TurtleCommand::draw_unrecorded:
    case TurtleCommand::sphere:
    case TurtleCommand::disc:
    case TurtleCommand::model:
        return true;
    default:
        return false;
    }
}

std::uint32_t PlantTally::closes_part() {
    sum_count_ += open_.back().sums.size();
    parts_.push_back(std::move(open_.back()));
    open_.pop_back();
    return static_cast<std::uint32_t>(parts_.size() - 1);
}

bool PlantTally::places(std::uint32_t number, double scale) {
    const Part& placed = parts_[number];
    Part& here = part();
    addition_count_ += placed.sums.size();
    if (addition_count_ > most_additions) return false;
    for (const auto& [key, sums] : placed.sums) {
        Key own = key;
        own.order += axis().order + (key.one_more && axis().leaves == Leaves::yes ? 1 : 0);
        own.one_more = axis().one_more || (key.one_more && axis().leaves == Leaves::as_before);
        if (here.whole) own.name = *here.whole;
        Sums& total = here.sums[own];
        const BigCount modules = total.modules;
        total.add(sums, scale);
        if (here.whole) total.modules = modules; // they are parts of one
        total.balls += sums.balls;
        total.unmeasured += sums.unmeasured;
    }
    if (placed.axes.front().leaves == Leaves::yes) axis().leaves = Leaves::yes;
    return true;
}

/// Sums of rows like the one that is added here.
PlantTally::Sums& PlantTally::add_row(SymbolId name, std::uint16_t material) {
    Part& here = part();
    Sums& sums = here.sums[{axis().order, axis().one_more, here.whole.value_or(name), material}];
    if (!here.whole) sums.modules += 1;
    axis().leaves = Leaves::yes;
    return sums;
}

bool PlantTally::begins(const Module& module, const Turtle&) {
    if (sum_count_ > most_sums) return false;
    const TurtleCommand command = grammar_.commands[module.symbol];
    if (!(module.is_interpreted ? is_plant_part(command) : command == TurtleCommand::none)) return true;
    const Leaves before = axis().leaves;
    add_row(module.symbol, no_organ);
    if (!module.is_interpreted) return true;
    part().whole = module.symbol;
    part().whole_depth = part().axes.size();
    axis().leaves = before; // parts are borne by what bears the whole
    return true;
}

void PlantTally::ends(const Turtle&) {
    Part& here = part();
    if (!here.whole) return;
    here.whole.reset();
    if (here.axes.size() == here.whole_depth) axis().leaves = Leaves::yes;
}

void PlantTally::runs(SymbolId symbol, std::span<const double>, const Turtle&) {
    running_ = symbol;
    const TurtleCommand command = grammar_.commands[symbol];
    if (command == TurtleCommand::open_branch) opens_branch();
    if (command == TurtleCommand::close_branch) closes_branch();
}

void PlantTally::draws(const DrawnBody& body) {
    SymbolId name = running_;
    if (body.organ == Organ::polygon) { // a polygon has the name of its beginning
        const auto begin = std::ranges::find(grammar_.commands, TurtleCommand::open_polygon);
        name = static_cast<SymbolId>(begin - grammar_.commands.begin());
    }
    Sums& sums =
        add_row(name, body.material.empty() ? own_material : number_of_material(materials_, body.material));
    if (is_segment(body)) {
        sums.segments += 1;
        sums.length += body.length;
        sums.wood_area += body.area;
        sums.wood_volume += body.volume;
    } else if (is_blade(body)) {
        sums.leaves += 1;
        sums.leaf_area += body.area;
    } else if (body.organ == Organ::ball) {
        sums.balls += 1;
    } else if (body.organ == Organ::model) {
        sums.unmeasured += 1;
    }
}

void PlantTally::opens_branch() {
    const Axis from = axis();
    part().axes.push_back({from.order + (from.leaves == Leaves::yes ? 1 : 0),
                           from.one_more || from.leaves == Leaves::as_before, Leaves::no});
}

void PlantTally::closes_branch() {
    if (part().axes.size() > 1) part().axes.pop_back();
}

PlantTotals PlantTally::totals() const {
    PlantTotals totals;
    totals.steps = steps_;
    std::map<SymbolId, PlantSums> names;
    std::map<std::uint16_t, PlantSums> materials;
    for (const auto& [key, sums] : open_.front().sums) {
        totals.all += sums;
        totals.balls += sums.balls;
        totals.unmeasured += sums.unmeasured;
        totals.orders.resize(key.order + 1); // keys come by their orders
        totals.orders.back() += sums;
        names[key.name] += sums;
        if (key.material != no_organ) materials[key.material] += sums;
    }
    for (const auto& [symbol, sums] : names)
        totals.names.push_back({sums, grammar_.symbols[symbol]});
    for (const auto& [number, sums] : materials)
        totals.materials.push_back({sums, number == own_material ? std::string() : materials_[number]});
    return totals;
}

} // namespace graftal
