#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/chaos/chaos_game.h"
#include "compiler/languages/lower.h"

namespace graftal::testing {

/// A model and all that random iteration needs of it.
struct Played {
    Graph graph;
    Components components;
    Contraction contraction;
    std::vector<ObjectBounds> bounds;

    double rate() const { return contraction.verdict == Verdict::proved ? contraction.certificate.rate : 0; }
    ChaosGame game() const { return ChaosGame::of(graph, components, bounds, rate()).value(); }
};

inline Played analysed(Graph graph) {
    Played played;
    played.graph = std::move(graph);
    played.components = strong_components(played.graph);
    played.contraction = decide_contraction(played.graph, played.components);
    played.bounds = bound_objects(played.graph, played.components, played.contraction);
    return played;
}

/// `name` says the language.
inline Played played(const std::string& name, const std::string& text) {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph = lower_text(name, text, {}, sources, diagnostics).graph;
    EXPECT_TRUE(graph) << diagnostics.render(sources);
    return analysed(graph ? std::move(*graph) : Graph());
}

/// Every `stride`-th of a sequence of points; with a stride longer than the words that are looked at, these
/// are independent.
inline std::vector<ChaosPoint> points_of(const ChaosGame& game, int count, int stride,
                                         std::uint64_t sequence = 0) {
    ChaosPlayer player(game, 1, sequence);
    std::vector<ChaosPoint> points;
    // Points of one wanderer are `grain` apart.
    std::vector<ChaosPoint> all(static_cast<std::size_t>(stride) * ChaosPlayer::grain);
    while (points.size() < static_cast<std::size_t>(count)) {
        player.fill(all);
        points.insert(points.end(), all.end() - ChaosPlayer::grain, all.end());
    }
    points.resize(static_cast<std::size_t>(count));
    return points;
}

/// Pearson's statistic: the mean is the number of cells with a share less one, its standard deviation the
/// root of twice that. Cells without a share must be empty, else it is infinite.
inline double chi_square(const std::vector<double>& counts, const std::vector<double>& shares) {
    double total = 0, sum = 0;
    for (const double count : counts)
        total += count;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (shares[i] == 0 && counts[i] > 0) return INFINITY;
        if (shares[i] > 0) sum += std::pow(counts[i] - total * shares[i], 2) / (total * shares[i]);
    }
    return sum;
}

/// Within five standard deviations of what chance gives: neither too far nor too near.
inline void expect_by_chance(const std::vector<double>& counts, const std::vector<double>& shares) {
    double freedom = -1;
    for (const double share : shares)
        freedom += share > 0;
    const double found = chi_square(counts, shares);
    EXPECT_LT(found, freedom + 5 * std::sqrt(2 * freedom) + 8);
    EXPECT_GT(found, freedom - 5 * std::sqrt(2 * freedom));
}

} // namespace graftal::testing
