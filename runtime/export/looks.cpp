#include "runtime/export/looks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "compiler/detail/bake.h"

namespace graftal {

namespace {

constexpr double look_grains[] = {1.0 / 255, 1.0 / 64, 1.0 / 16, 1.0 / 6, 1.0 / 3};
/// Pictures on what is long are told apart by eighths of their number along it.
constexpr double turns_grain = 1.0 / 8;
constexpr std::size_t most_resolved_parts = 8'000'000;

/// A node as it looks, in whole steps.
struct LookKey {
    SceneId node = 0;
    std::int64_t material = -1;
    std::array<std::int32_t, 4> tint{};
    std::array<std::int32_t, 3> inherited{};
    std::int32_t turns = 0;
    auto operator<=>(const LookKey&) const = default;
};

class LookResolver {
  public:
    LookResolver(const ExportedScene& scene, double grain, std::size_t most_nodes, std::size_t most_parts)
        : scene_(scene), grain_(grain), most_nodes_(most_nodes), most_parts_(most_parts) {
        // Whether what a node inherits shows anywhere below it.
        open_.resize(scene.nodes.size());
        for (const SceneId id : scene.masters_first) {
            bool open = scene.nodes[id].shape.has_value();
            for_each_part(scene, scene.nodes[id], [&](const ScenePart& part) {
                open = open || (!part.material && open_[part.node]);
            });
            open_[id] = open;
        }
    }

    std::optional<ExportedScene> resolve() {
        resolved_.shapes = scene_.shapes;
        resolved_.materials = scene_.materials;
        resolved_.bounds = scene_.bounds;
        resolved_.culled = scene_.culled;
        resolved_.root = node_for(scene_.root, {});
        while (!waiting_.empty()) {
            const auto [id, source, look] = waiting_.back();
            waiting_.pop_back();
            bool fits = true;
            std::vector<ScenePart> parts;
            for_each_part(scene_, scene_.nodes[source], [&](const ScenePart& part) {
                if (!fits || ++parts_ > most_parts_ || resolved_.nodes.size() > most_nodes_) {
                    fits = false;
                    return;
                }
                ScenePart placed;
                placed.node_from_part = part.node_from_part;
                placed.turns = part.turns;
                placed.node = node_for(part.node, look_through(scene_, look, scene_.nodes[source], part));
                parts.push_back(placed);
            });
            if (!fits) return std::nullopt;
            resolved_.nodes[id].parts = std::move(parts);
        }
        sort_masters_first(resolved_);
        return std::move(resolved_);
    }

  private:
    struct Waiting {
        SceneId id, source;
        SceneLook look;
    };

    std::int32_t steps(double value) const { return static_cast<std::int32_t>(std::lround(value / grain_)); }

    SceneId node_for(SceneId source, SceneLook look) {
        look.tint = rounded(look.tint, grain_);
        if (look.tint.alpha > 0) look.inherited = glm::round(look.inherited / grain_) * grain_;
        if (look.tint.alpha >= 1) look.inherited = Rgb(0.0);
        if (!open_[source]) {
            look.inherited = SceneLook().inherited;
            look.material.reset();
        }
        const SceneNode& node = scene_.nodes[source];
        const bool pictured =
            node.shape && look.material && !scene_.materials[*look.material].texture.empty();
        look.turns = pictured ? std::max(std::round(look.turns / turns_grain), 1.0) * turns_grain : 1;
        LookKey key;
        key.node = source;
        if (look.material) key.material = *look.material;
        key.tint = {steps(look.tint.premultiplied.r), steps(look.tint.premultiplied.g),
                    steps(look.tint.premultiplied.b), steps(look.tint.alpha)};
        for (int i = 0; i < 3; ++i)
            key.inherited[static_cast<std::size_t>(i)] =
                static_cast<std::int32_t>(std::lround(look.inherited[i] * 4096));
        key.turns = static_cast<std::int32_t>(std::clamp(look.turns / turns_grain, 1.0, 1e8));
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

    const ExportedScene& scene_;
    const double grain_;
    const std::size_t most_nodes_, most_parts_;
    std::vector<bool> open_;
    ExportedScene resolved_;
    std::map<LookKey, SceneId> known_;
    std::vector<Waiting> waiting_;
    std::size_t parts_ = 0;
};

} // namespace

std::optional<ResolvedLooks> resolve_looks(const ExportedScene& scene, std::size_t most_nodes,
                                           std::size_t most_parts) {
    for (const double grain : look_grains)
        if (auto resolved = LookResolver(scene, grain, most_nodes, most_parts).resolve())
            return ResolvedLooks{std::move(*resolved), grain};
    return std::nullopt;
}

std::optional<ExportedScene> resolve_looks(const ExportedScene& scene, std::size_t most_nodes, Span model,
                                           Diagnostics& diagnostics) {
    std::optional<ResolvedLooks> resolved = resolve_looks(scene, most_nodes, most_resolved_parts);
    if (!resolved) {
        diagnostics
            .error(model, fmt::format("parts of this model look different in more than {} ways: too many for "
                                      "a file that shares them",
                                      most_nodes))
            .with_hint(
                "leave out more with a larger --error or fewer --steps, or choose a flat format, .obj or "
                ".ply");
        return std::nullopt;
    }
    if (resolved->grain > look_grains[0])
        diagnostics.warning(model,
                            fmt::format("this model has so many tints that graftal tells them apart by "
                                        "1/{:.0f} only: a part looks the same wherever the file "
                                        "places it",
                                        1 / resolved->grain));
    return std::move(resolved->scene);
}

} // namespace graftal
