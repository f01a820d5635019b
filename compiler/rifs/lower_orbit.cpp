#include "compiler/rifs/lower_orbit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/lower_settings.h"
#include "compiler/rifs/orbit_model.h"
#include "compiler/rifs/system.h"
#include "compiler/support/number.h"
#include "compiler/syntax/lost_value.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

constexpr double most_skipped = 1e9;
constexpr double largest_factor = 1e6; ///< of `follow`
// With all functions written out:
constexpr std::size_t most_words = 100'000;          ///< of one formula
constexpr std::size_t most_words_in_all = 2'000'000; ///< of all formulas of a block
constexpr std::size_t most_depth = 2'000;            ///< of one formula: recursion follows it

class OrbitLowering {
  public:
    OrbitLowering(const RifsFile& tree, const OrbitBlock& block, Lowering& lowering)
        : block_(block), lowering_(lowering), diagnostics_(lowering.diagnostics) {
        model_.lets = block_lets(evaluate_lets(tree.statements, {}, lowering_));
        check_set_names(model_.lets, {}, tree.statements, lowering_);
        lower_settings(tree.statements, model_.lets, model_.scene, lowering_);
    }

    OrbitModel lower() && {
        model_.name = block_.name.text;
        model_.span = block_.name.span;
        lower_start();
        lower_restart();
        RifsLooks looks(model_.lets, model_.scene.materials, diagnostics_);
        if (block_.maps.empty())
            diagnostics_.error(block_.name.span, fmt::format("'orbit {}' has no map", block_.name.text))
                .with_hint("x = ...  y = ...");
        for (const OrbitMap& map : block_.maps)
            if (std::optional<OrbitFormulas> formulas = lower_map(map, looks))
                model_.maps.push_back(std::move(*formulas));
        check_probabilities();
        if (block_.last) model_.last = lower_map(*block_.last, looks);
        if (block_.follow) lower_follow(*block_.follow);
        add_colours();
        return std::move(model_);
    }

  private:
    /// A block's own lets; `--set` replaces their values too.
    Environment block_lets(Environment names) {
        for (const OrbitLet& let : block_.lets) {
            const auto set = lowering_.options.set.find(let.name.text);
            const std::optional<double> value = set != lowering_.options.set.end()
                                                    ? set->second
                                                    : evaluate(expanded(let.value), names, diagnostics_);
            names.insert_or_assign(std::string(let.name.text), value.value_or(lost_value));
        }
        return names;
    }

    const OrbitFunction* function_named(std::string_view name) const {
        for (const OrbitFunction& function : block_.functions)
            if (function.name.text == name) return &function;
        return nullptr;
    }

    /// The expression with the block's functions written out: each may use those above it.
    Expression expanded(const Expression& e) {
        words_ = 0;
        too_long_ = false;
        Expression written = expanded(e, block_.functions.size(), {}, 1);
        words_in_all_ += words_;
        return written;
    }

    /// Whether the formula may have so many more words, at this depth; if not, that is reported once, and
    /// nothing more is written out.
    bool has_room(const Expression& e, std::size_t words, std::size_t depth) {
        if (too_long_) return false;
        words_ += words;
        const bool all = words_in_all_ + words_ > most_words_in_all;
        if (words_ <= most_words && depth <= most_depth && !all) return true;
        too_long_ = true;
        if (all && std::exchange(all_too_long_, true)) return false;
        diagnostics_.error(
            e.span, all ? fmt::format("the formulas of 'orbit {}' have more than {} words, with "
                                      "all functions written out",
                                      block_.name.text, most_words_in_all)
                    : depth > most_depth ? fmt::format("this formula nests more than {} deep", most_depth)
                                         : fmt::format("this formula has more than {} words", most_words));
        return false;
    }

    using Arguments = std::vector<std::pair<std::string_view, const Expression*>>;

    /// `depth`: of the expression in the formula.
    Expression expanded(const Expression& e, std::size_t known, const Arguments& arguments,
                        std::size_t depth) {
        if (!has_room(e, 1, depth)) return {};
        Expression copy;
        if (e.kind == Expression::Kind::name && !arguments.empty()) {
            for (const auto& [name, value] : arguments)
                if (e.text == name) {
                    const ExpressionExtent extent = extent_of(*value, {});
                    return has_room(e, extent.words, depth + extent.depth) ? *value : Expression();
                }
            // A function reads the block's constants, whatever a map calls its own.
            if (const auto constant = model_.lets.find(e.text);
                constant != model_.lets.end() && !std::isnan(constant->second)) {
                copy.number = constant->second;
                copy.span = e.span;
                return copy;
            }
        }
        copy.kind = e.kind;
        copy.number = e.number;
        copy.text = e.text;
        copy.span = e.span;
        for (const Expression& operand : e.operands)
            copy.operands.push_back(expanded(operand, known, arguments, depth + 1));
        return e.kind == Expression::Kind::call ? call_written_out(std::move(copy), known, depth) : copy;
    }

    Expression call_written_out(Expression call, std::size_t known, std::size_t depth) {
        const OrbitFunction* function = function_named(call.text);
        if (!function) return call;
        const auto place = static_cast<std::size_t>(function - block_.functions.data());
        if (place >= known) {
            diagnostics_.error(call.span, fmt::format("'{}' is not defined above", call.text))
                .with_note(function->name.span, "it is defined here");
            return {};
        }
        if (call.operands.size() != function->parameters.size()) {
            diagnostics_
                .error(call.span,
                       fmt::format("'{}' takes {} argument{}, not {}", call.text, function->parameters.size(),
                                   function->parameters.size() == 1 ? "" : "s", call.operands.size()))
                .with_note(function->name.span, "it is defined here");
            return {};
        }
        Arguments arguments;
        for (std::size_t i = 0; i < call.operands.size(); ++i)
            arguments.emplace_back(function->parameters[i].text, &call.operands[i]);
        return expanded(function->body, place, arguments, depth);
    }

    void lower_start() {
        for (std::size_t i = 0; i < block_.start.size(); ++i)
            model_.start[static_cast<int>(i)] =
                evaluate(expanded(block_.start[i]), model_.lets, diagnostics_).value_or(0);
        if (!block_.skip) return;
        const double skip = evaluate(expanded(*block_.skip), model_.lets, diagnostics_).value_or(0);
        if (!(skip >= 0 && skip <= most_skipped && skip == std::floor(skip)))
            diagnostics_.error(
                block_.skip->span,
                fmt::format("'skip' must be a whole number from 0 to 1e9, not {}", shortest(skip)));
        else
            model_.skip = static_cast<std::uint64_t>(skip);
    }

    void lower_restart() {
        if (!block_.restart) return;
        model_.restart = evaluate(expanded(*block_.restart), model_.lets, diagnostics_).value_or(1);
        if (!(model_.restart > 0 && model_.restart <= farthest_of_orbit))
            diagnostics_.error(block_.restart->span,
                               fmt::format("'restart' must be above 0 and at most {}, not {}",
                                           shortest(farthest_of_orbit), shortest(model_.restart)));
    }

    std::optional<OrbitFormulas> lower_map(const OrbitMap& map, RifsLooks& looks) {
        OrbitFormulas formulas;
        formulas.name = map.name.text;
        formulas.span = map.span;
        formulas.names = {"x", "y", "z"};
        formulas.tint = looks.tint(map.look);
        formulas.material = looks.material(map.look);
        const std::optional<double> p = evaluate_probability(map.probability, model_.lets, diagnostics_);
        formulas.probability = p.value_or(map.probability ? 0 : 1);
        stated_ += map.probability.has_value();
        for (const OrbitLet& let : map.lets) {
            formulas.names.emplace_back(let.name.text);
            formulas.sources.push_back(expanded(let.value));
        }
        static const Expression zero;
        for (int axis = 0; axis < 3; ++axis) {
            const std::optional<Expression>& coordinate = map.coordinates[axis];
            if (!coordinate && axis < 2)
                diagnostics_.error(map.span, fmt::format("this map has no formula '{} = ...'", "xyz"[axis]));
            if (coordinate && axis == 2) model_.flat = false;
            formulas.sources.push_back(coordinate ? expanded(*coordinate) : zero);
        }
        if (diagnostics_.has_errors()) return std::nullopt;
        compile(formulas);
        return formulas;
    }

    /// Sources stay where they are when the formulas are moved: their vector's memory goes along.
    void compile(OrbitFormulas& formulas) {
        const std::size_t own = formulas.sources.size() - 3;
        std::vector<std::string_view> visible = {"x", "y", "z"};
        for (std::size_t i = 0; i < formulas.sources.size(); ++i) {
            if (i > 0 && i <= own) visible.push_back(formulas.names[2 + i]);
            std::uint32_t draws = 0;
            const auto code =
                ExpressionCode::compile(formulas.sources[i], model_.lets, visible, diagnostics_, &draws);
            if (!code) continue;
            formulas.codes.push_back(*code);
            formulas.draws.push_back(draws);
            formulas.all_draws += draws;
        }
    }

    void lower_follow(const RifsFollow& follow) {
        const std::size_t size = model_.maps.size();
        if (diagnostics_.has_errors()) return;
        const auto wrong = [&](const RifsMatrixRow& row) { return row.columns != size; };
        if (const auto row = std::ranges::find_if(follow.rows, wrong);
            row != follow.rows.end() || follow.rows.size() != size) {
            const std::string maps = fmt::format("{} map{}", size, size == 1 ? "" : "s");
            diagnostics_.error(
                row != follow.rows.end() ? row->span : follow.span,
                fmt::format("the matrix of 'orbit {}' needs {} rows of as many numbers, for it has {}",
                            block_.name.text, size, maps));
            return;
        }
        model_.follow.assign(size * size, 0);
        for (const RifsCell& cell : follow.cells) {
            double value = cell.number;
            if (cell.expression != RifsCell::literal)
                value = evaluate(follow.expressions[cell.expression], model_.lets, diagnostics_).value_or(0);
            if (!(value >= 0 && value <= largest_factor))
                diagnostics_.error(cell.span, fmt::format("an entry must lie between 0 and {}, not {}",
                                                          shortest(largest_factor), shortest(value)));
            model_.follow[cell.row * size + cell.column] = value;
        }
        for (std::size_t row = 0; row < size && !diagnostics_.has_errors(); ++row) {
            double sum = 0;
            for (std::size_t i = 0; i < size; ++i)
                sum += model_.follow[row * size + i] * model_.maps[i].probability;
            if (!(sum > 0))
                diagnostics_.error(follow.rows[row].span,
                                   fmt::format("no map may follow map {}: the orbit would end", row + 1));
        }
    }

    void check_probabilities() {
        if (diagnostics_.has_errors()) return;
        const auto maps = model_.maps.size();
        if (stated_ > 0 && stated_ < maps)
            diagnostics_.error(block_.name.span, "either all maps have a probability, or none")
                .with_hint("without any, all maps are equally likely");
        double sum = 0;
        for (const OrbitFormulas& map : model_.maps)
            sum += map.probability;
        if (!(sum > 0) && maps > 0)
            diagnostics_.error(block_.name.span,
                               fmt::format("the probabilities of 'orbit {}' are all 0", block_.name.text));
    }

    /// Adds an object of the maps' colours, by which the background is chosen.
    void add_colours() {
        const ObjectId sphere = model_.scene.primitive(PrimitiveKind::sphere);
        Object root;
        root.name = model_.name;
        for (const OrbitFormulas& map : model_.maps)
            root.instances.push_back({sphere, Affine(), map.tint, map.material, map.span});
        if (model_.last)
            root.instances.push_back(
                {sphere, Affine(), model_.last->tint, model_.last->material, model_.last->span});
        model_.scene.root = model_.scene.add(std::move(root));
    }

    const OrbitBlock& block_;
    Lowering& lowering_;
    Diagnostics& diagnostics_;
    OrbitModel model_;
    std::size_t stated_ = 0;
    std::size_t words_ = 0; ///< of the formula that is being written out
    bool too_long_ = false;
    std::size_t words_in_all_ = 0; ///< of those before it
    bool all_too_long_ = false;
};

bool may_stand_there(const RifsFile& tree, Lowering& lowering) {
    const OrbitBlock& orbit = tree.orbits.front();
    Diagnostics& diagnostics = lowering.diagnostics;
    if (!tree.blocks.empty() || !tree.uses.empty() || tree.orbits.size() > 1) {
        Diagnostic& error = diagnostics.error(orbit.span, "an orbit must be alone in its file");
        const Span other = !tree.blocks.empty() ? tree.blocks.front().name.span
                           : !tree.uses.empty() ? tree.uses.front().name.span
                                                : tree.orbits[1].span;
        error.with_note(other, "this statement is beside it");
        return false;
    }
    if (lowering.at_root_model() && lowering.options.may_be_orbit) return true;
    diagnostics
        .error(orbit.span,
               fmt::format("'orbit {}' consists of formulas, not of instances: it has no graph, only points",
                           orbit.name.text))
        .with_hint(lowering.at_root_model() ? "'graftal points' draws it, 'graftal check' checks it"
                                            : "'graftal points' draws it; no model can use it");
    return false;
}

} // namespace

// The codes point into the sources, whose memory must go along when a model moves.
static_assert(std::is_nothrow_move_constructible_v<OrbitFormulas>);

void lower_orbit_file(const RifsFile& tree, Lowering& lowering) {
    // A used model fails by an error of its own, whatever went wrong before.
    if (lowering.at_root_model() && lowering.diagnostics.has_errors()) return;
    if (!may_stand_there(tree, lowering)) return;
    OrbitModel model = OrbitLowering(tree, tree.orbits.front(), lowering).lower();
    if (lowering.diagnostics.has_errors()) return;
    lowering.notes.orbit = std::make_shared<const OrbitModel>(std::move(model));
}

namespace {

/// Computes the formulas in order, as far as they have values: how many do. `values` then holds those of x,
/// y, z and of the names, and behind them the random numbers of the formula that has none.
std::size_t compute(const OrbitFormulas& map, Vec3 point, std::span<const double> draws,
                    std::vector<double>& values, Vec3& image) {
    const std::size_t own = map.codes.size() - 3;
    values.clear();
    for (int axis = 0; axis < 3; ++axis)
        values.push_back(point[axis]);
    for (std::size_t i = 0; i < map.codes.size(); ++i) {
        // A formula finds its random numbers behind the names that it may use.
        const std::size_t names = values.size();
        values.insert(values.end(), draws.begin(), draws.begin() + map.draws[i]);
        draws = draws.subspan(map.draws[i]);
        const std::optional<double> value = map.codes[i].value(values);
        if (!value) return i;
        values.resize(names);
        if (i < own)
            values.push_back(*value);
        else
            image[static_cast<int>(i - own)] = *value;
    }
    return map.codes.size();
}

} // namespace

std::optional<Vec3> apply(const OrbitFormulas& map, Vec3 point, std::span<const double> draws,
                          std::vector<double>& slots) {
    Vec3 image;
    if (compute(map, point, draws, slots, image) < map.codes.size()) return std::nullopt;
    return image;
}

void OrbitModel::report(std::size_t number, Vec3 point, std::span<const double> draws,
                        Diagnostics& diagnostics) const {
    const OrbitFormulas& map = number < maps.size() ? maps[number] : *last;
    std::vector<double> values;
    Vec3 image;
    const std::size_t fault = compute(map, point, draws, values, image);
    if (fault == map.codes.size()) return;
    const std::vector<std::string_view> visible(
        map.names.begin(),
        map.names.begin() + static_cast<std::ptrdiff_t>(std::min(3 + fault, map.names.size())));
    map.codes[fault].report(values, lets, visible, diagnostics);
}

} // namespace graftal
