#include "compiler/detail/shadow/lit_colours.h"

#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/settle.h"

namespace graftal {

namespace {

double scatter_of(const Material& material) {
    return (material.diffuse + material.translucency) * (1 - material.transparency);
}

/// Colours that scatter light below a node, weighted by the visible area.
struct Lit {
    Rgb known{0.0};      ///< colour times scatter, of parts whose finish is known
    double scatter = 0;  ///< of these
    Rgb fixed{0.0};      ///< colour, of parts that inherit their finish
    double open = 1;     ///< share of these that inherit their colour, too
    double inherits = 1; ///< share of all parts

    void add(double weight, const Lit& other) {
        known += weight * other.known;
        scatter += weight * other.scatter;
        fixed += weight * other.fixed;
        open += weight * other.open;
        inherits += weight * other.inherits;
    }
};

constexpr Lit nothing{Rgb(0.0), 0, Rgb(0.0), 0, 0};

Lit made_of(const Lit& lit, const Material& material) {
    const double scatter = scatter_of(material);
    return {lit.known + scatter * (lit.fixed + lit.open * material.rgb), lit.scatter + scatter * lit.inherits,
            Rgb(0.0), 0, 0};
}

Lit tinted(const Lit& lit, const PathTint& tint) {
    const double rest = 1 - tint.alpha;
    return {rest * lit.known + lit.scatter * tint.premultiplied, lit.scatter,
            rest * lit.fixed + lit.inherits * tint.premultiplied, rest * lit.open, lit.inherits};
}

Lit lit_of(const DetailGraph& cut, const DetailNode& node, const std::vector<Lit>& below) {
    Lit sum = nothing;
    double weights = 0;
    for (const DetailEdge& edge : node.edges)
        weights += edge.weight;
    for (const DetailEdge& edge : node.edges) {
        Lit lit = below[edge.child];
        if (edge.material) lit = made_of(lit, cut.materials[*edge.material]);
        sum.add(edge.weight / weights, tinted(lit, edge.tint));
    }
    return sum;
}

Lit lit_of_cell(const DetailGraph& cut, const EdgeCell& cell) {
    Lit sum = nothing;
    double shadow = 0;
    cell.for_each_shadow([&](const std::optional<MaterialId>&, double area) { shadow += area; });
    if (!(shadow > 0)) return {};
    cell.for_each_shadow([&](const std::optional<MaterialId>& material, double area) {
        sum.add(area / shadow, material ? made_of(Lit(), cut.materials[*material]) : Lit());
    });
    return sum;
}

} // namespace

void set_lit_colours(DetailGraph& cut) {
    std::vector<Lit> lit(cut.nodes.size());
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        if (cut.nodes[id].cell) lit[id] = lit_of_cell(cut, *cut.nodes[id].cell);
    settle(cut, 48, 1e-7, [&](NodeId id) {
        const Lit before = std::exchange(lit[id], lit_of(cut, cut.nodes[id], lit));
        return std::max({glm::length(lit[id].known - before.known), glm::length(lit[id].fixed - before.fixed),
                         std::abs(lit[id].open - before.open)});
    });
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        DetailNode& node = cut.nodes[id];
        node.lit.reset();
        if (node.primitive) continue;
        const double scatter = node.finish ? scatter_of(cut.materials[*node.finish]) : Material().diffuse;
        if (!(scatter > 0) || lit[id].scatter == 0) continue;
        node.lit = MeanColour{glm::min(lit[id].known / scatter + lit[id].fixed, Rgb(1.0)), lit[id].open};
    }
}

} // namespace graftal
