#include "compiler/chaos/chaos_game.h"

namespace graftal {

ChaosPlayer::ChaosPlayer(const ChaosGame& game, std::uint64_t seed, std::uint64_t sequence)
    : game_(game), random_(seed, sequence), wanderers_(game.cores_.size()), settled_(game.cores_.size(), false) {}

void ChaosPlayer::wander(Wanderer& wanderer) {
    const ChaosGame::State& state = game_.states_[wanderer.state];
    const ChaosGame::Move& move = game_.moves_[game_.tables_.choose(state.wander, random_.bits())];
    wanderer.place = move.map(wanderer.place);
    wanderer.paint = wanderer.paint.under(move.paint);
    wanderer.map = move.label;
    wanderer.state = move.to;
}

void ChaosPlayer::settle(std::uint32_t core) {
    Wanderer& wanderer = wanderers_[core];
    wanderer.state = game_.entries_[game_.tables_.choose(game_.cores_[core].start, random_.bits())];
    wanderer.place = game_.middles_[wanderer.state];
    for (std::uint32_t i = 0; i < game_.settling_; ++i)
        wander(wanderer);
    settled_[core] = true;
}

ChaosPoint ChaosPlayer::next() {
    const bool only = game_.source_choice_.count == 1;
    const ChaosGame::Source& source =
        game_.sources_[only ? 0 : game_.tables_.choose(game_.source_choice_, random_.bits())];
    if (source.core == ChaosGame::none)
        return climb({source.surface->point(random_), source.paint, source.state, 0}, source.material, std::nullopt);
    if (!settled_[source.core]) settle(source.core);
    Wanderer& wanderer = wanderers_[source.core];
    const ChaosGame::Core& core = game_.cores_[source.core];
    do
        wander(wanderer);
    while (!core.always_leaves && random_.unit() >= game_.states_[wanderer.state].leave);
    return climb(wanderer, ChaosGame::none, core.base);
}

ChaosPoint ChaosPlayer::climb(Wanderer at, std::uint32_t material, const std::optional<Rgb>& base) {
    const ChaosGame::State* state = &game_.states_[at.state];
    while (!state->at_root) {
        const ChaosGame::Move& move = game_.moves_[state->climb.count == 1
                                                       ? game_.tables_.choose(state->climb, 0)
                                                       : game_.tables_.choose(state->climb, random_.bits())];
        if (move.to == ChaosGame::none) break;
        if (!move.identity) at.place = move.map(at.place);
        at.paint = at.paint.under(move.paint);
        if (material == ChaosGame::none) material = move.material;
        if (move.label != 0) at.map = move.label;
        state = &game_.states_[move.to];
    }
    const Rgb behind = base                             ? *base
                       : material != ChaosGame::none ? game_.materials_[material]
                                                     : Material{}.rgb;
    const float through = at.paint.through;
    return {at.place,
            {at.paint.red + through * static_cast<float>(behind.r),
             at.paint.green + through * static_cast<float>(behind.g),
             at.paint.blue + through * static_cast<float>(behind.b)},
            at.map};
}

} // namespace graftal
