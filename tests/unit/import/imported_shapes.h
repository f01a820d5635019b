#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/graph/components.h"
#include "compiler/graph/unfold.h"
#include "compiler/import/importers.h"
#include "compiler/languages/lower.h"

namespace graftal::testing {

/// A foreign text, translated and compiled, and what it draws.
struct ImportedShapes {
    ImportedShapes(const std::string& name, const std::string& text, std::uint64_t seed = 0) {
        const FileId file = sources.add(name, text);
        TranslateOptions translate;
        translate.seed = seed;
        const ForeignFile foreign = foreign_file(file, sources, diagnostics, translate);
        const Importer* const importer = importer_of(foreign);
        if (!importer) return;
        const std::vector<ForeignModel> models = importer->models(foreign);
        if (models.empty()) return;
        std::optional<Translation> translated = importer->translate(foreign, models.front());
        if (!translated) return;
        translation = translated->text;
        lines = translated->origins.size();
        LowerOptions options;
        options.may_be_orbit = true;
        LoweredText lowered =
            lower_text("m." + std::string(translated->extension), translation, options, sources, lowering);
        graph = std::move(lowered.graph);
        orbit = lowered.notes.orbit != nullptr;
    }

    std::string said() const { return diagnostics.render(sources) + lowering.render(sources); }

    std::vector<UnfoldedLeaf> leaves(std::optional<unsigned> steps = {}) const {
        std::vector<UnfoldedLeaf> all;
        if (!graph) return all;
        unfold(*graph, strong_components(*graph), steps, 100'000, [&](const UnfoldedLeaf& leaf) {
            all.push_back(leaf);
            return true;
        });
        return all;
    }

    SourceMap sources;
    Diagnostics diagnostics, lowering;
    std::string translation;
    std::size_t lines = 0;
    std::optional<Graph> graph;
    bool orbit = false;
};

} // namespace graftal::testing
