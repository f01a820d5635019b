#include "tests/property/meaning.h"

#include <algorithm>
#include <cmath>

#include "compiler/graph/components.h"
#include "compiler/graph/print.h"
#include "compiler/graph/unfold.h"
#include "compiler/graph/verify.h"
#include "compiler/passes/pipeline.h"
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

std::string text_of(const Graph& graph, const UnfoldedLeaf& leaf) {
    std::string out = leaf.primitive ? name_of(*leaf.primitive) : "proxy";
    out += ' ';
    for (int column = 0; column < 3; ++column)
        append(out, leaf.world_from_object.linear[column]);
    append(out, leaf.world_from_object.translation);
    append(out, leaf.tint.premultiplied);
    append(out, leaf.tint.alpha);
    if (leaf.material) out += graph.materials[*leaf.material].name;
    return out;
}

std::string violation_by(const Pass& pass, const std::string& law) {
    return std::string(pass.name) + ": " + law;
}

} // namespace

Meaning meaning_of(const Graph& graph, unsigned steps, std::uint64_t max_leaves) {
    Meaning meaning;
    meaning.complete =
        unfold(graph, strong_components(graph), steps, max_leaves, [&](const UnfoldedLeaf& leaf) {
            meaning.leaves.push_back(text_of(graph, leaf));
            return true;
        });
    std::sort(meaning.leaves.begin(), meaning.leaves.end());
    return meaning;
}

LawCheck check_laws(Graph graph, unsigned max_steps, std::uint64_t max_leaves) {
    LawCheck check;
    for (const Pass& pass : pipeline()) {
        const Graph after = pass.run(graph);
        if (const std::vector<Flaw> flaws = verify(after); !flaws.empty()) {
            check.violation = violation_by(pass, flaws.front().message);
            return check;
        }
        for (unsigned steps = 0; steps <= max_steps; ++steps) {
            const Meaning expected = meaning_of(graph, steps, max_leaves);
            if (!expected.complete) break;
            ++check.depths_compared;
            if (meaning_of(after, steps, max_leaves) == expected) continue;
            check.violation = violation_by(pass, "the meaning changed at level " + std::to_string(steps));
            return check;
        }
        if (print(pass.run(after)) != print(after))
            check.violation = violation_by(pass, "a second run changed the graph");
        else if (print(pass.run(graph)) != print(after))
            check.violation = violation_by(pass, "two runs gave different graphs");
        if (!check.violation.empty()) return check;
        graph = after;
    }
    return check;
}

} // namespace graftal::testing
