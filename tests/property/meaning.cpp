#include "tests/property/meaning.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/text/print.h"
#include "compiler/graph/unfold.h"
#include "compiler/graph/verify.h"
#include "compiler/passes/renumbering.h"
#include "compiler/support/number.h"

namespace graftal::testing {

namespace {

/// To the last bit, except for the sign of zero. Huge transforms may overflow on the way down.
void append(std::string& out, double value) {
    out += std::isnan(value) ? "nan" : shortest(value);
    out += ' ';
}

void append(std::string& out, Vec3 v) {
    for (int i = 0; i < 3; ++i)
        append(out, v[i]);
}

/// Straight colours that meet in a pass are rounded there.
Vec3 rounded(Vec3 v) {
    return {std::round(v.x * 1e9) * 1e-9, std::round(v.y * 1e9) * 1e-9, std::round(v.z * 1e9) * 1e-9};
}

std::string text_of(const Graph& graph, const UnfoldedLeaf& leaf, bool round_tints) {
    std::string out = leaf.primitive ? name_of(*leaf.primitive) : "proxy";
    out += ' ';
    for (int column = 0; column < 3; ++column)
        append(out, leaf.world_from_object.linear[column]);
    append(out, leaf.world_from_object.translation);
    append(out, round_tints ? rounded(leaf.tint.premultiplied) : leaf.tint.premultiplied);
    append(out, round_tints ? rounded(Vec3(leaf.tint.alpha)).x : leaf.tint.alpha);
    if (leaf.material) out += graph.materials[*leaf.material].name;
    return out;
}

/// `moved`: proxies are those of the graph that this pass made; tints are rounded.
Meaning meaning_after(const Graph& graph, const Renumbering* moved, bool round_tints, unsigned steps,
                      std::uint64_t max_leaves) {
    Meaning meaning;
    meaning.complete = unfold(graph, strong_components(graph), steps, max_leaves, [&](UnfoldedLeaf leaf) {
        if (!leaf.primitive && moved && !moved->taken.empty()) {
            const Renumbering::Taken& taken = moved->taken[leaf.object];
            leaf.world_from_object = leaf.world_from_object * taken.parent_from_rest;
            leaf.tint = leaf.tint * PathTint(taken.tint);
            if (taken.material) leaf.material = taken.material;
        }
        meaning.leaves.push_back(text_of(graph, leaf, round_tints));
        return true;
    });
    std::sort(meaning.leaves.begin(), meaning.leaves.end());
    return meaning;
}

/// What is wrong with the bounds that a pass has carried over, or "". They may be wider than those that are
/// found anew: the search for them ends where its effort does.
std::string fault_of_bounds(const Graph& graph, const std::vector<ObjectBounds>& carried) {
    const Components components = strong_components(graph);
    const Contraction contraction = decide_contraction(graph, components);
    const std::vector<ObjectBounds> found = bound_objects(graph, components, contraction);
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const Box &box = carried[id].box, &exact = found[id].box;
        if (box.empty() != exact.empty() || carried[id].unbounded != found[id].unbounded)
            return "bounds of another kind";
        if (box.empty()) continue;
        const double slack = 1e-8 * (1 + largest_entry(exact.size()));
        const double out = std::max(largest_entry(glm::max(box.min - exact.min, Vec3(0.0))),
                                    largest_entry(glm::max(exact.max - box.max, Vec3(0.0))));
        if (out > slack) return "an object is out of its bounds";
    }
    return "";
}

std::string violation_by(const Pass& pass, const std::string& law) {
    return std::string(pass.name) + ": " + law;
}

} // namespace

Meaning meaning_of(const Graph& graph, unsigned steps, std::uint64_t max_leaves) {
    return meaning_after(graph, nullptr, false, steps, max_leaves);
}

LawCheck check_laws(std::span<const Pass> passes, BoundedGraph graph, unsigned max_steps,
                    std::uint64_t max_leaves) {
    LawCheck check;
    const bool bounded = !graph.bounds.empty();
    for (const Pass& pass : passes) {
        const Rewritten after = pass.run(graph.graph, graph.bounds);
        const auto broken = [&](const std::string& law) { check.violation = violation_by(pass, law); };
        if (const std::vector<Flaw> flaws = verify(after.graph); !flaws.empty()) {
            broken(flaws.front().message);
            return check;
        }
        for (unsigned steps = 0; steps <= max_steps; ++steps) {
            const Meaning expected =
                meaning_after(graph.graph, &after.renumbering, bounded, steps, max_leaves);
            if (!expected.complete) break;
            ++check.depths_compared;
            if (meaning_after(after.graph, nullptr, bounded, steps, max_leaves) == expected) continue;
            broken("the meaning changed at level " + std::to_string(steps));
            return check;
        }
        const std::vector<ObjectBounds> carried =
            bounded ? carried_over(after.renumbering, graph.bounds) : std::vector<ObjectBounds>();
        if (after.renumbering.now.size() != graph.graph.objects.size() ||
            after.renumbering.origin.size() != after.graph.objects.size())
            broken("the renumbering is of other graphs");
        else if (pass.settles && print(pass.run(after.graph, carried).graph) != print(after.graph))
            broken("a second run changed the graph");
        else if (print(pass.run(graph.graph, graph.bounds).graph) != print(after.graph))
            broken("two runs gave different graphs");
        else if (const std::string fault = bounded ? fault_of_bounds(after.graph, carried) : "";
                 !fault.empty())
            broken(fault);
        if (!check.violation.empty()) return check;
        check.moved += static_cast<unsigned>(after.renumbering.united.size());
        if (after.graph.objects.size() > graph.graph.objects.size())
            check.parts += static_cast<unsigned>(after.graph.objects.size() - graph.graph.objects.size());
        graph = {after.graph, carried};
    }
    return check;
}

} // namespace graftal::testing
