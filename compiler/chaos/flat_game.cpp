#include "compiler/chaos/flat_game.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace graftal {

namespace {

/// Slots of a table that one random number of 32 bits chooses from, with chances kept to 2^-20.
constexpr std::uint32_t most_slots_by_one = 4096;
/// Share of z in x and y, relative to their own size, that rounding alone may give.
constexpr double rounding = 1e-12;

bool ignores_depth(const Affine& map) {
    const Vec3 depth = map.linear[2];
    return std::max(std::abs(depth.x), std::abs(depth.y)) <= rounding * largest_entry(map.linear);
}

} // namespace

void FlatGame::add_move(const Affine& map, const Paint& paint, const glm::uvec4& move_links) {
    for (int row = 0; row < 3; ++row)
        moves.emplace_back(map.linear[0][row], map.linear[1][row], map.linear[2][row], map.translation[row]);
    moves.emplace_back(paint.fixed[0], paint.fixed[1], paint.fixed[2], paint.open);
    links.push_back(move_links);
}

void FlatGame::add_choices(const AliasTables& tables) {
    for (const AliasTables::Entry& entry : tables.entries())
        choices.emplace_back(entry.own, entry.choice, entry.alias, 0);
    wide = choices.size() > most_slots_by_one;
}

std::optional<FlatGame> FlatGame::of(const ChaosGame& game, const Affine& seen_from_world,
                                     const LabelColour& colour_of, std::string& why) {
    if (game.sources_.size() != 1 || game.sources_.front().core == ChaosGame::none) {
        why = "its kernel knows only systems whose maps follow each other without end";
        return std::nullopt;
    }
    FlatGame flat;
    const ChaosGame::Core& core = game.cores_[game.sources_.front().core];
    const Affine world_from_seen = inverse(seen_from_world);
    const auto links_of = [](const AliasTables::Range& table, std::uint32_t more) {
        return glm::uvec4(table.first, table.count, more, 0);
    };
    flat.add_choices(game.tables_);

    std::vector<bool> wanders(game.moves_.size(), false);
    const auto each_move_of = [&](const AliasTables::Range& table, const auto& visit) {
        for (std::uint32_t i = table.first; i < table.first + table.count; ++i)
            for (const std::uint32_t move : {flat.choices[i].y, flat.choices[i].z})
                visit(move);
    };
    for (const ChaosGame::State& state : game.states_) {
        each_move_of(state.wander, [&](std::uint32_t move) { wanders[move] = true; });
        flat.states.emplace_back(state.at_root ? 0 : state.climb.first, state.at_root ? 0 : state.climb.count,
                                 std::bit_cast<std::uint32_t>(static_cast<float>(state.leave)), 0);
    }
    flat.flat = true;
    double most_open = 0;
    for (std::size_t i = 0; i < game.moves_.size(); ++i) {
        const ChaosGame::Move& move = game.moves_[i];
        const Affine map = seen_from_world * move.map * world_from_seen;
        flat.flat = flat.flat && ignores_depth(map);
        Paint paint = move.paint;
        if (colour_of) paint = move.label == 0 ? Paint() : Paint(MeanColour{colour_of(move.label), 0});
        if (move.to == ChaosGame::none)
            flat.add_move(map, paint, glm::uvec4(0, 0, none, 0));
        else if (wanders[i]) {
            flat.add_move(map, paint, links_of(game.states_[move.to].wander, move.to));
            most_open = std::max<double>(most_open, paint.open);
        } else
            flat.add_move(map, paint,
                          glm::uvec4(flat.states[move.to].x, flat.states[move.to].y,
                                     core.base || colour_of ? none : move.material, 0));
    }

    // Points begin by a move, too: from anywhere to the middle of a state.
    flat.start = core.start;
    const auto first_start = static_cast<std::uint32_t>(flat.links.size());
    const auto state_of = [&](std::uint32_t entry) { return game.entries_[entry]; };
    std::uint32_t starts = 0;
    for (std::uint32_t i = core.start.first; i < core.start.first + core.start.count; ++i) {
        glm::uvec4& choice = flat.choices[i];
        for (std::uint32_t* const chosen : {&choice.y, &choice.z}) {
            const std::uint32_t state = state_of(*chosen);
            const Affine middle{Mat3(0.0), seen_from_world(game.middles_[state])};
            flat.add_move(middle, Paint(), links_of(game.states_[state].wander, state));
            *chosen = first_start + starts++;
        }
    }
    flat.settling = 1 + game.settling_ / 2; // to single precision
    flat.sees_through = std::pow(most_open, flat.settling) > 1e-4;
    flat.climbs = !core.in_world;
    flat.leaves = !core.always_leaves;
    for (const Rgb& material : game.materials_)
        flat.add_colour(material);
    flat.add_colour(colour_of ? colour_of(0) : core.base.value_or(Material{}.rgb));
    return flat;
}

} // namespace graftal
