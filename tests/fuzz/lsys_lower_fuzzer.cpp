// `.lsys` from text to verified graph, and through all passes: any input gives a graph or diagnostics, soon.

#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"
#include "compiler/passes/pipeline.h"
#include "compiler/support/check.h"

namespace graftal {
namespace {

/// Lowers, and gives the number of modules of the word, "" without one.
std::string lower_and_check(const std::string& text, bool exact) {
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.exact = exact;
    options.max_objects = 2000;
    options.max_modules = 20'000;
    auto [graph, notes] = lower_text("no_such_folder/fuzz.lsys", text, options, sources, diagnostics);
    GRAFTAL_CHECK(graph.has_value() != diagnostics.has_errors(), "lsys fuzzer: a graph or errors");
    diagnostics.render(sources);
    if (!graph) return {};
    check_verified(*graph, "lsys fuzzer: after lowering");
    const Graph result = run_passes(model_passes(), {std::move(*graph), {}}).graph;
    check_verified(result, "lsys fuzzer: after the passes");
    const Components components = strong_components(result);
    const Contraction contraction = decide_contraction(result, components);
    if (contraction.verdict == Verdict::acyclic || contraction.verdict == Verdict::proved)
        bound_objects(result, components, contraction);
    const std::optional<Derivation>& derivation = notes.derivation;
    return derivation && derivation->variants == 1 ? derivation->modules : std::string();
}

} // namespace
} // namespace graftal

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const std::string composed = lower_and_check(text, false), derived = lower_and_check(text, true);
    // Where chance has no part, both ways of compiling see one word.
    GRAFTAL_CHECK(composed.empty() || derived.empty() || composed == derived,
                  "lsys fuzzer: two ways, one word");
    return 0;
}
