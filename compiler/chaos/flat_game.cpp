#include "compiler/chaos/flat_game.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "compiler/graph/run.h"
#include "compiler/primitives/primitive.h"
#include "compiler/primitives/tapered.h"

namespace graftal {

namespace {

#include "compiler/chaos/forms.glsl"

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

/// Writes a game.
class FlatGame::Writer {
  public:
    Writer(const ChaosGame& game, const Affine& seen_from_world, const LabelColour& colour_of)
        : game_(game), seen_from_world_(seen_from_world), colour_of_(colour_of), tables_(game.tables_) {}

    std::optional<FlatGame> write(std::string& why) && {
        const auto core = std::ranges::find_if(
            game_.sources_, [](const ChaosGame::Source& source) { return source.core != ChaosGame::none; });
        if (core != game_.sources_.end()) core_ = &game_.cores_[core->core];
        flat_.flat = true;
        add_states();
        add_moves();
        const bool others = core_ == nullptr || game_.sources_.size() > 1;
        if (others && !add_sources(why)) return std::nullopt;
        flat_.add_choices(tables_);
        if (core_) add_beginnings();
        if (others) add_source_choice();
        flat_.climbs = others || !core_->in_world;
        flat_.leaves = core_ && !core_->always_leaves;
        flat_.settling = core_ ? 1 + game_.settling_ / 2 : 0; // to single precision
        flat_.sees_through = others || std::pow(most_open_, flat_.settling) > 1e-4;
        add_colours();
        return std::move(flat_);
    }

  private:
    static constexpr std::size_t most_forms = 1'000'000;

    static glm::uvec4 links_of(const AliasTables::Range& table, std::uint32_t more) {
        return {table.first, table.count, more, 0};
    }
    AliasTables::Range climb_of(std::uint32_t state) const {
        const ChaosGame::State& from = game_.states_[state];
        return from.at_root ? AliasTables::Range() : from.climb;
    }
    std::uint32_t material_of(std::uint32_t material) const { return colour_of_ ? none : material; }

    void add_states() {
        for (std::uint32_t i = 0; i < game_.states_.size(); ++i) {
            const AliasTables::Range climb = climb_of(i);
            flat_.states.emplace_back(
                climb.first, climb.count,
                std::bit_cast<std::uint32_t>(static_cast<float>(game_.states_[i].leave)), 0);
        }
    }

    void add_moves() {
        const Affine world_from_seen = inverse(seen_from_world_);
        std::vector<bool> wanders(game_.moves_.size(), false);
        for (const ChaosGame::State& state : game_.states_)
            for (std::uint32_t i = state.wander.first; i < state.wander.first + state.wander.count; ++i)
                wanders[tables_.entries()[i].choice] = wanders[tables_.entries()[i].alias] = true;
        for (std::size_t i = 0; i < game_.moves_.size(); ++i) {
            const ChaosGame::Move& move = game_.moves_[i];
            const Affine map = seen_from_world_ * move.map * world_from_seen;
            flat_.flat = flat_.flat && ignores_depth(map);
            Paint paint = move.paint;
            if (colour_of_) paint = move.label == 0 ? Paint() : Paint(MeanColour{colour_of_(move.label), 0});
            if (wanders[i]) most_open_ = std::max<double>(most_open_, paint.open);
            flat_.add_move(map, paint,
                           move.to == ChaosGame::none ? links_of({}, none)
                           : wanders[i]               ? links_of(game_.states_[move.to].wander, move.to)
                                        : links_of(climb_of(move.to), material_of(move.material)));
        }
    }

    /// Points of the core begin by a move, too: from anywhere to the middle of a state.
    void add_beginnings() {
        flat_.start = core_->start;
        for (std::uint32_t i = core_->start.first; i < core_->start.first + core_->start.count; ++i)
            for (std::uint32_t* const chosen : {&flat_.choices[i].y, &flat_.choices[i].z}) {
                const std::uint32_t state = game_.entries_[*chosen];
                *chosen = static_cast<std::uint32_t>(flat_.links.size());
                flat_.add_move({Mat3(0.0), seen_from_world_(game_.middles_[state])}, Paint(),
                               links_of(game_.states_[state].wander, state));
            }
    }

    bool add_sources(std::string& why) {
        flat_.first_form = static_cast<std::uint32_t>(flat_.links.size());
        std::size_t cores = 0;
        for (const ChaosGame::Source& source : game_.sources_) {
            moves_of_sources_.push_back(
                source.core == ChaosGame::none ? static_cast<std::uint32_t>(flat_.links.size()) : none);
            if (source.core != ChaosGame::none)
                why = ++cores > 1 ? "its kernel knows one cycle without a way out" : "";
            else if (!(source.packed ? add_items(source) : add_surface(source)))
                why = "its kernel knows no points of such a surface";
            if (flat_.links.size() - flat_.first_form > most_forms)
                why = "its kernel has no room for so many parts";
            if (!why.empty()) return false;
        }
        return true;
    }

    void add_source_choice() {
        flat_.sources = game_.source_choice_;
        for (std::uint32_t i = flat_.sources.first; i < flat_.sources.first + flat_.sources.count; ++i)
            for (std::uint32_t* const chosen : {&flat_.choices[i].y, &flat_.choices[i].z})
                *chosen = moves_of_sources_[*chosen];
    }

    /// A surface as a form stretched by a map; `top`: the upper radius of what tapers. Where area grows alike
    /// everywhere, `most_growth` is 0.
    void add_form(std::uint32_t kind, double top, const Affine& map, double most_growth, const Paint& paint,
                  const glm::uvec4& links) {
        const Affine seen = seen_from_world_ * map;
        flat_.flat = flat_.flat && ignores_depth(seen);
        flat_.add_move(seen, paint, links);
        flat_.forms.emplace_back(kind, top, most_growth, 0);
        const Mat3 cofactors = cofactors_of(map.linear);
        for (int column = 0; column < 3; ++column)
            flat_.forms.emplace_back(glm::vec3(cofactors[column]), 0);
    }
    void add_form(std::uint32_t kind, double top, const Affine& map, const Paint& paint,
                  const glm::uvec4& links) {
        add_form(kind, top, map, norm(cofactors_of(map.linear)), paint, links);
    }

    /// Several surfaces, which follow, by their areas. False where these have none.
    bool add_group(const std::vector<double>& areas) {
        if (!(std::accumulate(areas.begin(), areas.end(), 0.0) > 0)) return false;
        const auto first = static_cast<std::uint32_t>(flat_.links.size() + 1);
        flat_.add_move(Affine(), Paint(), links_of(tables_.add(areas, first), none));
        flat_.forms.resize(flat_.forms.size() + 4, glm::vec4(FORM_GROUP));
        return true;
    }

    bool add_items(const ChaosGame::Source& source) {
        std::vector<double> areas;
        for (std::size_t i = 0; i < source.packed.item_count(); ++i) {
            const ItemAreas of_item = areas_of((*source.packed.run)[i]);
            areas.insert(areas.end(), {of_item.body, of_item.ball});
        }
        if (!add_group(areas)) return false;
        for (std::size_t i = 0; i < source.packed.item_count(); ++i) {
            const RunItem& item = (*source.packed.run)[i];
            const glm::uvec4 links = links_of(climb_of(source.state),
                                              material_of(source.packed.material_of_item(i).value_or(none)));
            const auto add_ball = [&](Vec3 middle) {
                add_form(FORM_SPHERE, 0, {Mat3(item.radius), middle}, 0, Paint(), links);
            };
            if (item.shape.is_sphere())
                add_ball(item.base);
            else
                add_form(FORM_TAPERED, item.shape.top_radius(), run_from_body(item), Paint(), links);
            add_ball(item.base + item.axis);
        }
        return true;
    }

    bool add_surface(const ChaosGame::Source& source) {
        const PlacedSurface& surface = *source.surface;
        const Paint paint = colour_of_ ? Paint() : source.paint;
        const glm::uvec4 links = links_of(climb_of(source.state), material_of(source.material));
        const auto add = [&](std::uint32_t kind, double top = 0) {
            add_form(kind, top, surface.map_, paint, links);
            return true;
        };
        switch (surface.primitive_.kind()) {
        case PrimitiveKind::triangle:
        case PrimitiveKind::polygon:
        case PrimitiveKind::bicubic_patch:
        case PrimitiveKind::mesh:
            return add_triangles(traits_of(surface.primitive_).mesh(surface.primitive_, 0), surface.map_,
                                 paint, links);
        case PrimitiveKind::sphere:
            return add(FORM_SPHERE);
        case PrimitiveKind::cube:
            return add(FORM_CUBE);
        case PrimitiveKind::torus:
            return add(FORM_TORUS);
        case PrimitiveKind::cylinder:
        case PrimitiveKind::cone:
        case PrimitiveKind::frustum:
            return add(FORM_TAPERED, top_radius(surface.primitive_));
        default:
            return false;
        }
    }

    bool add_triangles(const TessellatedPrimitive& mesh, const Affine& map, const Paint& paint,
                       const glm::uvec4& links) {
        std::vector<Affine> maps;
        std::vector<double> areas;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 first = map(mesh.vertices[a]);
            const Vec3 across = map(mesh.vertices[b]) - first, up = map(mesh.vertices[c]) - first;
            maps.push_back({Mat3(across, up, Vec3(0.0)), first});
            areas.push_back(glm::length(glm::cross(across, up)));
        }
        if (maps.size() > 1 && !add_group(areas)) return false;
        for (const Affine& placed : maps)
            add_form(FORM_TRIANGLE, 0, placed, 0, paint, links);
        return true;
    }

    void add_colours() {
        for (const Rgb& material : game_.materials_)
            flat_.add_colour(material);
        if (core_ && core_->base && !colour_of_) {
            flat_.core_colour = static_cast<std::uint32_t>(flat_.colours.size());
            flat_.add_colour(*core_->base);
        }
        flat_.add_colour(colour_of_ ? colour_of_(0) : Material{}.rgb);
    }

    const ChaosGame& game_;
    const Affine& seen_from_world_;
    const LabelColour& colour_of_;
    AliasTables tables_;
    const ChaosGame::Core* core_ = nullptr;
    double most_open_ = 0; ///< paint of a move in the core
    std::vector<std::uint32_t> moves_of_sources_;
    FlatGame flat_;
};

std::optional<FlatGame> FlatGame::of(const ChaosGame& game, const Affine& seen_from_world,
                                     const LabelColour& colour_of, std::string& why) {
    return Writer(game, seen_from_world, colour_of).write(why);
}

} // namespace graftal
