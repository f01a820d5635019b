#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/graph/print.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"
#include "compiler/support/check.h"

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

} // namespace graftal
