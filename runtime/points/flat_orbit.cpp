#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/syntax/steps/expression_steps.h"
#include "runtime/points/orbit_source.h"

namespace graftal {

namespace {

/// Slots of a map's images, before those of x, y and z.
constexpr std::uint32_t images = 3;
constexpr std::uint32_t most_slots = 256;
/// Moves at the beginning that one piece of a card's work may have.
constexpr std::uint64_t most_skipped = 50'000;

/// The formulas of a map, as compute() of the kernel reads them.
bool add_formulas(const OrbitFormulas& map, ExpressionSteps& to) {
    const auto own = static_cast<std::uint32_t>(map.codes.size() - 3);
    for (std::uint32_t i = 0; i < map.codes.size(); ++i) {
        const std::uint32_t first_draw = images + 3 + std::min(i, own), free = first_draw + map.draws[i];
        for (std::uint32_t draw = first_draw; draw < free; ++draw)
            to.add_draw(draw);
        if (!to.add(map.codes[i], images, free, i < own ? first_draw : i - own)) return false;
    }
    return true;
}

glm::uvec4 packed(const ExpressionStep& step) {
    const auto& o = step.operands;
    return {step.operation | (step.whole ? 256u : 0u) | step.result << 16, o[0] | o[1] << 16,
            o[2] | o[3] << 16, step.pieces};
}

} // namespace

std::optional<FlatGame> OrbitSource::flat(const Affine& seen_from_world, const LabelColour& colour_of,
                                          std::string& why) const {
    if (single()) {
        why = "one map has one orbit, which is not to be divided";
        return std::nullopt;
    }
    if (model_.skip > most_skipped) {
        why = fmt::format("'skip' leaves out more than {} points, too many for one piece of its work",
                          most_skipped);
        return std::nullopt;
    }
    FlatGame flat;
    flat.formulas = true;
    flat.add_choices(tables_);
    flat.start = choices_.front();
    ExpressionSteps steps;
    double most_open = 0;
    bool good = true;
    const auto add = [&](const OrbitFormulas* map, Paint paint, const AliasTables::Range& next) {
        const auto first = static_cast<std::uint32_t>(steps.steps.size());
        if (map) good = good && add_formulas(*map, steps);
        const std::uint32_t material =
            map && map->material && !colour_of ? static_cast<std::uint32_t>(*map->material) : FlatGame::none;
        flat.add_move(seen_from_world, paint, {next.first, next.count, 0, material});
        flat.states.emplace_back(first, static_cast<std::uint32_t>(steps.steps.size()) - first, 0, 0);
    };
    for (std::size_t i = 0; i < model_.maps.size(); ++i) {
        const OrbitFormulas& map = model_.maps[i];
        const Paint paint = colour_of ? Paint(MeanColour{colour_of(static_cast<std::uint32_t>(i + 1)), 0})
                                      : Paint(PathTint(map.tint));
        most_open = std::max<double>(most_open, paint.open);
        add(&map, paint, choices_[choices_.size() > 1 ? i + 1 : 0]);
    }
    add(model_.last ? &*model_.last : nullptr,
        model_.last && !colour_of ? Paint(PathTint(model_.last->tint)) : Paint(), {});
    if (!good || steps.slots > most_slots) {
        why = "its kernel has no room for these formulas";
        return std::nullopt;
    }
    for (const ExpressionStep& step : steps.steps)
        flat.steps.push_back(packed(step));
    flat.numbers = std::move(steps.numbers);
    flat.slots = steps.slots;
    flat.settling = static_cast<std::uint32_t>(model_.skip);
    flat.origin = glm::vec4(model_.start, 0);
    flat.restart = static_cast<float>(model_.restart);
    flat.sees_through = std::pow(most_open, flat.settling) > 1e-4;
    for (const Material& material : model_.scene.materials)
        flat.add_colour(material.rgb);
    flat.add_colour(Material{}.rgb);
    return flat;
}

} // namespace graftal
