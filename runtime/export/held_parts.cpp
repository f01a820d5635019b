#include "runtime/export/held_parts.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "runtime/export/equal_nodes.h"

namespace graftal {

namespace {

constexpr SceneId nothing = UINT32_MAX;
/// The name that asks for all objects; none has it.
constexpr std::string_view all_objects = "*";

bool bears(std::string_view name, std::string_view asked) {
    return name == asked ||
           (name.size() > asked.size() && name.starts_with(asked) && name[asked.size()] == '.');
}

/// Nodes that bear one of the names. Nothing, after an error, for a name that no part has.
std::optional<std::vector<bool>> named_parts(const UnfoldedScene& scene,
                                             const std::vector<std::string>& names, Span model,
                                             Diagnostics& diagnostics) {
    std::vector<bool> is_named(scene.nodes.size(), false);
    for (const std::string& asked : names) {
        if (asked == all_objects) continue;
        bool found = false;
        for (SceneId id = 0; id < scene.nodes.size(); ++id) {
            if (!bears(scene.nodes[id].name, asked)) continue;
            is_named[id] = found = true;
        }
        if (found) continue;
        std::set<std::string> known;
        for (const SceneNode& node : scene.nodes)
            known.insert(node.name);
        diagnostics.error(model, fmt::format("no part of the file is called '{}'", asked))
            .with_hint(choices(asked, {known.begin(), known.end()}));
        return std::nullopt;
    }
    return is_named;
}

/// Two halves of each node: without named parts, and of nothing else.
class Halves {
  public:
    Halves(UnfoldedScene& scene, const std::vector<bool>& is_named)
        : scene_(scene), rest_(is_named.size(), nothing), held_(is_named.size(), nothing) {
        for (const SceneId id : scene.masters_first) {
            const bool leads_on = std::ranges::any_of(
                scene.nodes[id].parts, [&](const ScenePart& part) { return held_[part.node] != nothing; });
            if (is_named[id]) {
                held_[id] = id;
            } else if (leads_on) {
                rest_[id] = half(id, rest_);
                held_[id] = half(id, held_);
            } else {
                rest_[id] = id;
            }
        }
    }

    SceneId rest(SceneId id) const { return rest_[id]; }
    SceneId held(SceneId id) const { return held_[id]; }

  private:
    /// The node with the halves of its parts; nothing where none of them has one.
    SceneId half(SceneId id, const std::vector<SceneId>& of) {
        SceneNode node = scene_.nodes[id];
        std::erase_if(node.parts, [&](const ScenePart& part) { return of[part.node] == nothing; });
        if (node.parts.empty()) return nothing;
        for (ScenePart& part : node.parts)
            part.node = of[part.node];
        scene_.nodes.push_back(std::move(node));
        return static_cast<SceneId>(scene_.nodes.size() - 1);
    }

    UnfoldedScene& scene_;
    std::vector<SceneId> rest_, held_;
};

/// Lays what an object draws itself beside the objects that it places: as a part of its own, in the place of
/// the first of those shapes. `held`: by node; what is held already stays whole.
void hold_each_object(UnfoldedScene& scene, std::vector<bool>& held) {
    const std::vector<SceneId> nodes = scene.masters_first;
    held.resize(scene.nodes.size(), false);
    for (const SceneId id : nodes) {
        std::vector<ScenePart> drawn, all;
        for (const ScenePart& part : scene.nodes[id].parts) {
            const bool is_shape = scene.nodes[part.node].shape.has_value();
            if (is_shape && drawn.empty()) all.emplace_back().node = static_cast<SceneId>(held.size());
            (is_shape ? drawn : all).push_back(part);
        }
        if (held[id] || drawn.empty()) continue;
        if (all.size() == 1) {
            held[id] = true;
            continue;
        }
        SceneNode own;
        own.name = scene.nodes[id].name;
        own.parts = std::move(drawn);
        scene.nodes[id].parts = std::move(all);
        scene.nodes.push_back(std::move(own));
        held.push_back(true);
    }
}

} // namespace

std::optional<std::vector<bool>> hold_parts(UnfoldedScene& scene, const std::vector<std::string>& names,
                                            Span model, Diagnostics& diagnostics) {
    unite_equal_nodes(scene);
    std::optional<std::vector<bool>> is_named = named_parts(scene, names, model, diagnostics);
    if (!is_named) return is_named;
    const Halves halves(scene, *is_named);
    const SceneId rest = halves.rest(scene.root), held = halves.held(scene.root);
    if (rest != nothing && held != nothing) {
        SceneNode both;
        both.name = scene.nodes[scene.root].name;
        for (const SceneId half : {rest, held})
            both.parts.push_back(
                {.node = half, .node_from_part = {}, .tint = {}, .material = {}, .colour = {}});
        scene.nodes.push_back(std::move(both));
        scene.root = static_cast<SceneId>(scene.nodes.size() - 1);
    }
    sort_masters_first(scene);
    is_named->resize(scene.nodes.size(), false);
    if (std::ranges::find(names, all_objects) == names.end()) return is_named;
    hold_each_object(scene, *is_named);
    sort_masters_first(scene);
    return is_named;
}

} // namespace graftal
