#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/import/importers.h"
#include "compiler/languages/lower.h"
#include "compiler/support/check.h"

namespace graftal::fuzz {

/// Any text by this name gives a graph, or errors, or nothing to draw; and the same each time.
inline int try_import(const std::string& name, const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    LowerOptions options;
    options.steps = 4;
    options.max_objects = 2000;
    options.max_modules = 20'000;
    options.may_draw_nothing = true;
    std::string first;
    for (int time = 0; time < 2; ++time) {
        SourceMap sources;
        Diagnostics diagnostics;
        const LoweredText lowered = lower_text("no_such_folder/" + name, text, options, sources, diagnostics,
                                               {.translator = importing_translator()});
        GRAFTAL_CHECK(lowered.graph || diagnostics.has_errors() || lowered.notes.derivation ||
                          lowered.notes.orbit,
                      "import fuzzer: a model or errors");
        std::string said = diagnostics.render(sources);
        for (FileId file = 0; file < sources.size(); ++file)
            if (sources.original(file)) said += sources.text(file);
        GRAFTAL_CHECK(time == 0 || said == first, "import fuzzer: the same each time");
        first = said;
    }
    return 0;
}

} // namespace graftal::fuzz
