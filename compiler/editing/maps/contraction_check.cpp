#include "compiler/editing/maps/contraction_check.h"

#include <utility>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/languages/languages.h"
#include "compiler/languages/lower.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/session/stages.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

std::string first_error(const Diagnostics& diagnostics) {
    for (const Diagnostic& finding : diagnostics.all())
        if (finding.severity == Severity::error) return finding.message;
    return {};
}

} // namespace

ContractionCheck check_contraction(const std::string& name, std::string text, const EditContext& context) {
    SourceMap sources;
    Diagnostics diagnostics;
    LoweredText lowered =
        lower_text(name, std::move(text), context.lower, sources, diagnostics, context.help);
    if (!lowered.graph) return {false, first_error(diagnostics)};
    AnalysedModel model;
    model.graph = std::move(*lowered.graph);
    model.components = strong_components(model.graph);
    model.contraction = decide_contraction(model.graph, model.components, context.help.control);
    Diagnostics verdict;
    if (!refuse_divergent(model, verdict)) return {true, {}};
    return {false, first_error(verdict)};
}

Environment lets_of(const Document& document, const LowerOptions& options) {
    SourceMap sources = document.sources();
    Diagnostics ignored;
    const LowerHelp help;
    WorkMeter meter(help.control, "lower", 10'000, StagePrice::word);
    ParsedFiles parsed;
    Lowering lowering{.sources = sources,
                      .diagnostics = ignored,
                      .options = options,
                      .help = help,
                      .meter = meter,
                      .languages = languages(),
                      .parsed = parsed};
    lowering.loading.push_back({document.name(), Span()});
    const std::vector<SceneStatement>* const statements = document.lsys()   ? &document.lsys()->statements
                                                          : document.rifs() ? &document.rifs()->statements
                                                          : document.inst() ? &document.inst()->scene
                                                                            : nullptr;
    return statements ? lower_lets(*statements, lowering) : Environment();
}

} // namespace graftal
