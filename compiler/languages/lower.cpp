#include "compiler/languages/lower.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/graph/verify.h"
#include "compiler/languages/languages.h"
#include "compiler/lower/check_graph.h"
#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lowering.h"
#include "compiler/support/number.h"
#include "compiler/support/path_text.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Modules, parts and objects after which the control is asked: some milliseconds.
constexpr std::uint64_t lowered_a_look = 10'000;

LoweredText lower_root(FileId file, const std::string& path, const LowerOptions& options, SourceMap& sources,
                       Diagnostics& diagnostics, const LowerHelp& help) {
    WorkMeter meter(help.control, "lower", lowered_a_look, StagePrice::word);
    ParsedFiles parsed_here;
    LowerOptions with_preset = options;
    Lowering lowering{.sources = sources,
                      .diagnostics = diagnostics,
                      .options = with_preset,
                      .help = help,
                      .meter = meter,
                      .languages = languages(),
                      .parsed = help.parsed ? *help.parsed : parsed_here};
    const Language* const language = language_of(file, sources, languages());
    if (options.time && !options.steps && !(language && language->has_time)) {
        diagnostics
            .error(Span{file, 0, 0}, fmt::format("only L-systems have times between two steps, such as {}",
                                                 shortest(*options.time)))
            .with_hint("give a whole number");
        return {};
    }
    if (language && !options.preset.empty()) {
        Diagnostics quiet; // what is wrong with the text is reported when it is lowered
        const std::vector<SceneStatement> statements =
            lowering.parsed.tree(*language, file, sources, languages(), quiet).inner_statements().file;
        if (!take_preset(statements, options.preset, file, with_preset, diagnostics)) return {};
    }
    lowering.loading.push_back({normalised_path(path), Span()});
    LoweredText model{lower_file(file, Span{file, 0, 0}, lowering), std::move(lowering.notes)};
    std::ranges::stable_sort(model.notes.parameters, {},
                             [](const ModelParameter& p) { return p.span.begin; });
    if (diagnostics.has_errors() || (model.graph && !check_graph(*model.graph, diagnostics))) return {};
    if (model.graph) check_verified(*model.graph, "lower");
    return model;
}

} // namespace

std::string model_language(const SourceMap& sources) {
    FileId file = 0;
    for (FileId made = 1; made < sources.size() && file == 0; ++made)
        if (sources.original(made) == 0u) file = made;
    if (const Language* const language = language_of(file, sources, languages()))
        return std::string(language->extension);
    const std::string_view extension = extension_of(sources.name(file));
    return std::string(extension.substr(extension.empty() ? 0 : 1));
}

LoweredText lower_text(const std::string& name, std::string text, const LowerOptions& options,
                       SourceMap& sources, Diagnostics& diagnostics, const LowerHelp& help) {
    const Translator& translator = help.translator;
    const ModelPath path = translator.model_path(name == "-" ? standard_input : name);
    const FileId file = sources.add(path.file, translator.model_text(path.file, std::move(text)));
    std::optional<FileId> own;
    {
        WorkMeter meter(help.control, "import", 10'000);
        own = translator.own_text(file, path.model, sources, diagnostics,
                                  {options.root, help.files, options.seed.value_or(0)}, &meter);
    }
    if (!own) return {};
    LoweredText lowered = lower_root(*own, name, options, sources, diagnostics, help);
    lowered.notes.asks_chance |= *own != file; // translators choose by the seed
    return lowered;
}

} // namespace graftal
