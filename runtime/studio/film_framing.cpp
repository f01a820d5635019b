#include "runtime/studio/film_framing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/session/stages.h"
#include "runtime/studio/asks.h"
#include "runtime/studio/message_reader.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

namespace {

/// Frames that are looked at, with the first and the last: those of a longer film lie between them.
constexpr std::uint64_t most_looked_at = 33;

/// Keys are pairs of a share of the film and a value, in their order.
double value_at(const nlohmann::json& keys, double share) {
    if (!keys.is_array() || keys.empty()) throw BadMessage("a knob of a film has no key frames");
    double last_share = 0, last = 0;
    bool is_first = true;
    for (const nlohmann::json& key : keys) {
        if (!key.is_array() || key.size() != 2) throw BadMessage("a key frame is a time and a value");
        const double next_share = film_number(key[0]), next = film_number(key[1]);
        if (share <= next_share && is_first) return next;
        if (share <= next_share)
            return std::lerp(last, next, (share - last_share) / (next_share - last_share));
        last_share = next_share;
        last = next;
        is_first = false;
    }
    return last;
}

/// The options of a moment.
void move_to(double share, const nlohmann::json& film, LowerOptions& lower) {
    const MessageReader fields(film);
    if (const nlohmann::json* const set = fields.object("set"))
        for (const auto& [name, keys] : set->items())
            lower.set[name] = value_at(keys, share);
    const auto steps = film.find("steps");
    if (steps == film.end() || steps->is_null()) return;
    if (!steps->is_array() || steps->size() != 2) throw BadMessage("'steps' is no list of two numbers");
    const double least = film_number((*steps)[0]), most = film_number((*steps)[1]);
    if (!(least >= 0 && most >= least && most <= static_cast<double>(most_steps)))
        throw BadMessage("'steps' is no range of steps");
    lower.steps.reset();
    lower.time = std::lerp(least, most, share);
    if (least == std::floor(least) && most == std::floor(most)) // as the command line has it
        lower.steps =
            static_cast<unsigned>(least + std::min(most - least, std::floor(share * (most - least + 1))));
}

std::uint64_t frames_of(const nlohmann::json& film) {
    return MessageReader(film).needed_whole("frames", UINT32_MAX);
}

} // namespace

void check_film(const nlohmann::json& film) {
    frames_of(film);
    LowerOptions unheard;
    constexpr double after_all = 2; // so that each key is read
    move_to(after_all, film, unheard);
}

std::shared_ptr<const SharedFraming> FilmFraming::of(const StudioState& state, Session& session) {
    const nlohmann::json& film = *state.film;
    const std::uint64_t frames = std::clamp<std::uint64_t>(frames_of(film), 2, most_looked_at);
    StageOptions stages = state.stages;
    stages.view.framing.reset();
    move_to(0, film, stages.lower);
    const LowerOptions& lower = stages.lower;
    const nlohmann::json made_from = nlohmann::json::array({
        state.name,
        *state.text,
        film,
        state.camera ? *state.camera : nlohmann::json(),
        {stages.view.size.width, stages.view.size.height},
        lower.set,
        lower.seed ? nlohmann::json(*lower.seed) : nlohmann::json(),
        lower.steps ? nlohmann::json(*lower.steps) : nlohmann::json(),
        lower.time ? nlohmann::json(*lower.time) : nlohmann::json(),
    });
    std::string key = made_from.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    if (key == known_) return framing_;
    auto framing = std::make_shared<SharedFraming>();
    bool is_empty = true;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        move_to(static_cast<double>(frame) / static_cast<double>(frames - 1), film, stages.lower);
        Compilation unheard; // the state's own findings are told
        const auto model = session.analysed(stages, unheard);
        if (session.control().cancel.raised()) return nullptr;
        if (!model) continue;
        framing->include(*model, levels_of(*model, stages.lower.steps));
        is_empty = false;
    }
    if (is_empty) return nullptr;
    framing->settle(stages.view.camera, stages.view.size, false);
    known_ = std::move(key);
    return framing_ = std::move(framing);
}

} // namespace graftal
