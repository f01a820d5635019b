#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/components.h"
#include "compiler/graph/unfold.h"
#include "compiler/import/importers.h"
#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"

namespace graftal::testing {

/// A foreign text, translated and compiled.
struct Imported {
    Imported(const std::string& name, const std::string& text, LowerOptions options = {}) {
        options.may_draw_nothing = true;
        LoweredText lowered = lower_text(name, text, options, sources, diagnostics,
                                         {.translator = importing_translator(), .files = &disk_files()});
        graph = std::move(lowered.graph);
        derivation = std::move(lowered.notes.derivation);
        for (FileId file = 0; file < sources.size(); ++file)
            if (sources.original(file) && translation.empty()) translation = sources.text(file);
    }

    std::string said() const { return diagnostics.render(sources); }

    /// The ends of all segments, without their balls.
    std::vector<std::pair<Vec3, Vec3>> segments() const {
        std::vector<std::pair<Vec3, Vec3>> all;
        if (!graph) return all;
        unfold(*graph, strong_components(*graph), std::nullopt, 100'000, [&](const UnfoldedLeaf& leaf) {
            const Affine& place = leaf.world_from_object;
            if (leaf.primitive && leaf.primitive->kind() == PrimitiveKind::cylinder)
                all.emplace_back(place.translation, place.translation + place.linear[1]);
            return true;
        });
        return all;
    }

    /// Where the segments end.
    std::vector<Vec3> ends() const {
        EXPECT_TRUE(graph) << said();
        std::vector<Vec3> all;
        for (const auto& [from, to] : segments())
            all.push_back(to);
        return all;
    }

    /// The radii of the segments, in the order of the word.
    std::vector<double> radii() const {
        std::vector<double> all;
        if (!graph) return all;
        unfold(*graph, strong_components(*graph), std::nullopt, 100, [&](const UnfoldedLeaf& leaf) {
            if (leaf.primitive && leaf.primitive->kind() == PrimitiveKind::cylinder)
                all.push_back(glm::length(leaf.world_from_object.linear[0]));
            return true;
        });
        return all;
    }

    /// The number of segments, or why there is none.
    std::string segment_count() const { return derivation ? derivation->segments : said(); }

    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph;
    std::optional<Derivation> derivation;
    std::string translation; ///< of the model itself
};

inline void expect_near(Vec3 a, Vec3 b) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(a[axis], b[axis], 1e-9) << "axis " << axis;
}

} // namespace graftal::testing
