#include "compiler/chaos/chaos_game.h"

namespace graftal {

namespace {

constexpr std::uint8_t unsettled = UINT8_MAX;

} // namespace

ChaosPlayer::ChaosPlayer(const ChaosGame& game, std::uint64_t seed, std::uint64_t sequence)
    : game_(game), random_(seed, sequence), wanderers_(together * game.cores_.size()),
      next_(game.cores_.size(), unsettled) {}

inline void ChaosPlayer::wander(Wanderer& wanderer) {
    const ChaosGame::State& state = game_.states_[wanderer.state];
    const ChaosGame::Move& move = game_.moves_[game_.tables_.choose(state.wander, random_.bits())];
    wanderer.place = move.map(wanderer.place);
    wanderer.paint = wanderer.paint.under(move.paint);
    wanderer.map = move.label;
    wanderer.state = move.to;
}

/// The wanderers of a core, once they have forgotten where they began.
ChaosPlayer::Wanderer* ChaosPlayer::settled(std::uint32_t core) {
    Wanderer* const wanderers = &wanderers_[together * core];
    if (next_[core] != unsettled) return wanderers;
    for (std::size_t w = 0; w < together; ++w) {
        Wanderer& wanderer = wanderers[w];
        wanderer.state = game_.entries_[game_.tables_.choose(game_.cores_[core].start, random_.bits())];
        wanderer.place = game_.middles_[wanderer.state];
        for (std::uint32_t i = 0; i < game_.settling_; ++i)
            wander(wanderer);
    }
    next_[core] = 0;
    return wanderers;
}

void ChaosPlayer::fill(std::span<ChaosPoint> points) {
    const ChaosGame::Source& first = game_.sources_.front();
    if (game_.sources_.size() == 1 && first.core != ChaosGame::none && game_.cores_[first.core].in_world)
        return fill_in_world(points);
    for (ChaosPoint& point : points)
        point = next();
}

/// The usual case of a system by itself: every move of every point is a point of the picture.
void ChaosPlayer::fill_in_world(std::span<ChaosPoint> points) {
    Wanderer* const wanderers = settled(0);
    const Rgb behind = game_.cores_.front().base.value_or(Material{}.rgb);
    for (std::size_t i = 0; i < points.size(); i += together)
        for (std::size_t w = 0; w < together && i + w < points.size(); ++w) {
            wander(wanderers[w]);
            points[i + w] = seen(wanderers[w], behind);
        }
}

ChaosPoint ChaosPlayer::next() {
    const bool only = game_.source_choice_.count == 1;
    const ChaosGame::Source& source =
        game_.sources_[only ? 0 : game_.tables_.choose(game_.source_choice_, random_.bits())];
    if (source.packed) {
        const std::size_t item = game_.tables_.choose(source.items, random_.bits());
        return climb({point_of_item(source.packed, item, random_), source.paint, source.state, 0},
                     source.packed.material_of_item(item).value_or(ChaosGame::none), std::nullopt);
    }
    if (source.core == ChaosGame::none)
        return climb({source.surface->point(random_), source.paint, source.state, 0}, source.material,
                     std::nullopt);
    Wanderer& wanderer = settled(source.core)[next_[source.core]];
    next_[source.core] = static_cast<std::uint8_t>((next_[source.core] + 1) % together);
    const ChaosGame::Core& core = game_.cores_[source.core];
    do
        wander(wanderer);
    while (!core.always_leaves && random_.unit() >= game_.states_[wanderer.state].leave);
    return climb(wanderer, ChaosGame::none, core.base);
}

ChaosPoint ChaosPlayer::climb(Wanderer at, std::uint32_t material, const std::optional<Rgb>& base) {
    const ChaosGame::State* state = &game_.states_[at.state];
    while (!state->at_root) {
        const std::uint64_t bits = state->climb.count == 1 ? 0 : random_.bits();
        const ChaosGame::Move& move = game_.moves_[game_.tables_.choose(state->climb, bits)];
        if (move.to == ChaosGame::none) break;
        if (!move.identity) at.place = move.map(at.place);
        at.paint = at.paint.under(move.paint);
        if (material == ChaosGame::none) material = move.material;
        if (move.label != 0) at.map = move.label;
        state = &game_.states_[move.to];
    }
    if (base) return seen(at, *base);
    return seen(at, material != ChaosGame::none ? game_.materials_[material] : Material{}.rgb);
}

inline ChaosPoint ChaosPlayer::seen(const Wanderer& at, const Rgb& behind) const {
    const auto& [fixed, open] = at.paint;
    return {at.place,
            {fixed[0] + open * static_cast<float>(behind.r), fixed[1] + open * static_cast<float>(behind.g),
             fixed[2] + open * static_cast<float>(behind.b)},
            at.map};
}

} // namespace graftal
