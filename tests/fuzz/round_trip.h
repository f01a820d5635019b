#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/import/importers.h"
#include "compiler/languages/lower.h"
#include "compiler/support/check.h"
#include "compiler/support/control.h"
#include "compiler/support/stage_work.h"

namespace graftal {

/// Small enough for thousands of models a second.
inline LowerOptions fuzz_options() {
    LowerOptions options;
    options.max_objects = 200;
    return options;
}

/// What must hold for any text: it gives a verified graph or an error that can be rendered, and the printed
/// graph reads back to an equal one.
inline void check_model_text(const char* name, const std::uint8_t* data, std::size_t size) {
    SourceMap sources;
    Diagnostics diagnostics;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const std::optional<Graph> graph = lower_text(name, text, fuzz_options(), sources, diagnostics).graph;
    GRAFTAL_CHECK(graph.has_value() != diagnostics.has_errors(), "a graph or an error");
    diagnostics.render(sources);
    if (!graph) return;
    check_verified(*graph, "fuzz");
    Diagnostics no_diagnostics;
    LowerOptions options;
    const std::optional<Graph> again =
        lower_text("printed.inst", print(*graph), options, sources, no_diagnostics).graph;
    GRAFTAL_CHECK(again.has_value(), no_diagnostics.render(sources));
    GRAFTAL_CHECK(equal(*graph, *again), "printed and read");
}

/// What must hold for any text of another program: each of its models gives text with one origin a line,
/// which gives a verified graph, an orbit or an error; or there is an error, or too much work.
inline void check_foreign_text_within_work(const char* name, const std::uint8_t* data, std::size_t size) {
    SourceMap sources;
    Diagnostics diagnostics;
    const FileId file = sources.add(name, std::string(reinterpret_cast<const char*>(data), size));
    StageWork work(1);
    Control control;
    control.work = &work;
    WorkMeter meter(control, "import", 1000);
    const ForeignFile foreign = foreign_file(file, sources, diagnostics, {}, &meter);
    const Importer* const importer = importer_of(foreign);
    GRAFTAL_CHECK(importer != nullptr || diagnostics.has_errors(), "an importer or an error");
    if (!importer) return;
    const std::vector<ForeignModel> models = importer->models(foreign);
    for (std::size_t i = 0; i < models.size() && i < 3; ++i) {
        const std::size_t errors = diagnostics.error_count();
        const std::optional<Translation> translation = importer->translate(foreign, models[i]);
        GRAFTAL_CHECK(translation.has_value() != (diagnostics.error_count() > errors), "a text or an error");
        if (!translation) continue;
        const auto lines = std::count(translation->text.begin(), translation->text.end(), '\n');
        GRAFTAL_CHECK(static_cast<std::size_t>(lines) == translation->origins.size(),
                      "an origin for each line");
        SourceMap own;
        Diagnostics said;
        LowerOptions options = fuzz_options();
        options.may_be_orbit = true;
        const std::string path = "no_such_folder/fuzz." + std::string(translation->extension);
        const LoweredText lowered = lower_text(path, translation->text, options, own, said);
        const bool made = lowered.graph.has_value() || lowered.notes.orbit != nullptr;
        GRAFTAL_CHECK(made != said.has_errors(), "a graph, an orbit or an error");
        said.render(own);
        if (lowered.graph) check_verified(*lowered.graph, "fuzz");
    }
    diagnostics.render(sources);
}

inline void check_foreign_text(const char* name, const std::uint8_t* data, std::size_t size) {
    try {
        check_foreign_text_within_work(name, data, size);
    } catch (const OutOfWork&) {
        return;
    }
}

} // namespace graftal
