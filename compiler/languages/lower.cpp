#include "compiler/languages/lower.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "compiler/graph/verify.h"
#include "compiler/languages/languages.h"
#include "compiler/lower/check_graph.h"
#include "compiler/lower/lowering.h"
#include "compiler/support/file.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Modules, parts and objects after which the control is asked: some milliseconds.
constexpr std::uint64_t lowered_a_look = 10'000;

LoweredText lower_root(FileId file, const LowerOptions& options, SourceMap& sources, Diagnostics& diagnostics,
                       const LowerHelp& help) {
    WorkMeter meter(help.control, "lower", lowered_a_look);
    Lowering lowering{.sources = sources,
                      .diagnostics = diagnostics,
                      .options = options,
                      .look_at_texture = help.look_at_texture,
                      .load_sky_picture = help.load_sky_picture,
                      .meter = meter,
                      .languages = languages()};
    const Language* const language = language_of(file, sources, languages());
    if (options.time && !options.steps && !(language && language->has_time)) {
        diagnostics
            .error(Span{file, 0, 0}, fmt::format("--steps {}: only L-systems have times between two steps",
                                                 shortest(*options.time)))
            .with_hint("give a whole number");
        return {};
    }
    const std::filesystem::path path(sources.name(file));
    lowering.loading.push_back({path.lexically_normal().string(), Span()});
    LoweredText model{lower_file(file, Span{file, 0, 0}, lowering), std::move(lowering.notes)};
    if (diagnostics.has_errors() || (model.graph && !check_graph(*model.graph, diagnostics))) return {};
    if (model.graph) check_verified(*model.graph, "lower");
    return model;
}

} // namespace

std::string model_language(FileId file, const SourceMap& sources) {
    if (const Language* const language = language_of(file, sources, languages()))
        return std::string(language->extension);
    const std::string extension = std::filesystem::path(sources.name(file)).extension().string();
    return extension.empty() ? "" : extension.substr(1);
}

LoweredText lower_model(const std::string& path, const LowerOptions& options, SourceMap& sources,
                        Diagnostics& diagnostics, Status& status, const LowerHelp& help) {
    std::string text;
    if (path != "-" && !options.root.empty() && !lies_in(path, options.root)) {
        diagnostics.error(Span(), fmt::format("'{}' leads out of --root '{}'", path, options.root));
        return {};
    }
    status = read_text(path, text);
    if (!status.ok()) return {};
    return lower_text(path, std::move(text), options, sources, diagnostics, help);
}

LoweredText lower_text(const std::string& name, std::string text, const LowerOptions& options,
                       SourceMap& sources, Diagnostics& diagnostics, const LowerHelp& help) {
    const FileId file = sources.add(name == "-" ? std::string(standard_input) : name, std::move(text));
    return lower_root(file, options, sources, diagnostics, help);
}

} // namespace graftal
