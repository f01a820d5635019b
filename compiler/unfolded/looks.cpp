#include "compiler/unfolded/looks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "compiler/detail/bake.h"

namespace graftal {

namespace {

/// The grain in which tints are told apart.
struct TintDetail {
    double grain = 0;
    /// A tint that leaves no more than this share to be seen of what is below hides all of it.
    double least_open = 0;
};
constexpr TintDetail tint_details[] = {{1.0 / 255, 0},      {1.0 / 64, 1.0 / 64}, {1.0 / 32, 1.0 / 16},
                                       {1.0 / 16, 1.0 / 4}, {1.0 / 8, 1.0 / 2},   {1.0 / 4, 1}};
/// Pictures on what is long are told apart by eighths of their number along it.
constexpr double turns_grain = 1.0 / 8;
constexpr std::size_t most_resolved_parts = 8'000'000;
constexpr double inherited_grain = 1.0 / 4096;

/// A node as it looks, in whole steps.
struct LookKey {
    SceneId node = 0;
    std::int64_t material = -1;
    std::array<std::int32_t, 4> tint{};
    std::array<std::int32_t, 3> inherited{};
    std::int32_t turns = 0;
    bool colourless = false;
    auto operator<=>(const LookKey&) const = default; // NOLINT: clang 14 sees a null pointer here
};

class LookResolver {
  public:
    LookResolver(const UnfoldedScene& scene, const TintDetail& detail, const LookLimits& limits,
                 std::size_t most_parts)
        : scene_(scene), detail_(detail), limits_(limits), most_parts_(most_parts), open_(scene.nodes.size()),
          tinted_(scene.nodes.size()) {
        for (const SceneId id : scene.masters_first) {
            bool open = scene.nodes[id].shape.has_value(), tinted = false;
            for_each_part(scene, scene.nodes[id], [&](const ScenePart& part) {
                open = open || (!part.material && open_[part.node]);
                tinted = tinted || part.tint.alpha > 0 || tinted_[part.node];
            });
            open_[id] = open;
            tinted_[id] = tinted;
        }
    }

    std::optional<UnfoldedScene> resolve() {
        resolved_.shapes = scene_.shapes;
        resolved_.materials = scene_.materials;
        resolved_.bounds = scene_.bounds;
        resolved_.culled = scene_.culled;
        SceneLook first;
        resolved_.root = node_for(scene_.root, first);
        while (!waiting_.empty()) {
            const Waiting at = waiting_.back();
            waiting_.pop_back();
            bool fits = true;
            std::vector<ScenePart> parts;
            const SceneNode& source = scene_.nodes[at.source];
            for_each_part(scene_, source, [&](const ScenePart& part) {
                fits = fits && ++parts_ <= most_parts_ && resolved_.nodes.size() <= limits_.nodes;
                if (fits) parts.push_back(resolved(part, look_through(scene_, at.look, source, part)));
            });
            if (!fits) return std::nullopt;
            resolved_.nodes[at.id].parts = std::move(parts);
        }
        sort_masters_first(resolved_);
        return std::move(resolved_);
    }

  private:
    struct Waiting {
        SceneId id, source;
        SceneLook look;
    };

    ScenePart resolved(const ScenePart& part, SceneLook look) {
        ScenePart placed;
        placed.node_from_part = part.node_from_part;
        placed.turns = part.turns;
        const SceneNode& node = scene_.nodes[part.node];
        const bool closes = !node.shape && !look.colourless && detail_.least_open > 0 &&
                            (look.is_tinted() || tinted_[part.node]) &&
                            1 - look.tint.alpha <= detail_.least_open;
        if (closes) {
            const Rgb colour = glm::clamp(look.tint.over(node.whole.over(look.inherited)), 0.0, 1.0);
            look.tint = PathTint(colour, 1);
            if (limits_.tints == TintsOn::instances) {
                look.colourless = true;
                placed.colour = colour;
            }
        }
        placed.node = node_for(part.node, look);
        return placed;
    }

    std::int32_t steps(double value) const {
        return static_cast<std::int32_t>(std::lround(value / detail_.grain));
    }

    SceneId node_for(SceneId source, SceneLook& look) {
        const SceneNode& node = scene_.nodes[source];
        look.tint = look.colourless ? PathTint() : rounded(look.tint, detail_.grain);
        // Parts of the look that do not show are set alike for all.
        if (look.tint.alpha >= 1 || look.colourless) look.inherited = Rgb(0.0);
        if (!open_[source]) {
            look.inherited = SceneLook().inherited;
            look.material.reset();
        }
        if (look.is_tinted()) look.inherited = glm::round(look.inherited / detail_.grain) * detail_.grain;
        const bool pictured =
            node.shape && look.material && !scene_.materials[*look.material].texture.empty();
        look.turns = pictured ? std::max(std::round(look.turns / turns_grain), 1.0) * turns_grain : 1;
        LookKey key;
        key.node = source;
        if (look.material) key.material = *look.material;
        const PathTint& tint = look.tint;
        key.tint = {steps(tint.premultiplied.r), steps(tint.premultiplied.g), steps(tint.premultiplied.b),
                    steps(tint.alpha)};
        for (int i = 0; i < 3; ++i)
            key.inherited[static_cast<std::size_t>(i)] =
                static_cast<std::int32_t>(std::lround(look.inherited[i] / inherited_grain));
        key.turns = static_cast<std::int32_t>(std::clamp(look.turns / turns_grain, 1.0, 1e8));
        key.colourless = look.colourless;
        const auto [known, is_new] = known_.try_emplace(key, static_cast<SceneId>(resolved_.nodes.size()));
        if (!is_new) return known->second;
        SceneNode& made = resolved_.nodes.emplace_back();
        made.name = node.name;
        if (node.shape) {
            made.shape = node.shape;
            made.look = look;
        } else {
            waiting_.push_back({known->second, source, look});
        }
        return known->second;
    }

    const UnfoldedScene& scene_;
    const TintDetail detail_;
    const LookLimits limits_;
    const std::size_t most_parts_;
    std::vector<bool> open_;   ///< by node: what it inherits shows somewhere below it
    std::vector<bool> tinted_; ///< by node: something below it has a tint
    UnfoldedScene resolved_;
    std::map<LookKey, SceneId> known_;
    std::vector<Waiting> waiting_;
    std::size_t parts_ = 0;
};

} // namespace

std::optional<UnfoldedScene> resolve_looks(const UnfoldedScene& scene, const LookLimits& limits, Span model,
                                           Diagnostics& diagnostics) {
    for (const TintDetail& detail : tint_details) {
        const bool last = &detail == std::end(tint_details) - 1;
        const std::size_t most_parts =
            last ? most_resolved_parts : std::min(most_resolved_parts, limits.wanted_parts);
        std::optional<UnfoldedScene> resolved = LookResolver(scene, detail, limits, most_parts).resolve();
        if (!resolved) continue;
        if (detail.least_open > 0)
            diagnostics.warning(
                model,
                fmt::format("this model has so many tints that graftal tells them apart by 1/{:.0f}, and "
                            "shows in its mean colour what lies behind tints{}",
                            1 / detail.grain,
                            last ? "" : fmt::format(" that leave 1/{:.0f} of it", 1 / detail.least_open)));
        return resolved;
    }
    diagnostics
        .error(model,
               fmt::format("this model has more than {} parts that differ in place or in look: too many "
                           "for a file that shares them",
                           most_resolved_parts))
        .with_hint("leave out more with a larger --error or fewer --steps, or choose a flat format, .obj or "
                   ".ply");
    return std::nullopt;
}

} // namespace graftal
