#include "compiler/import/cpfg/importer.h"

#include <algorithm>
#include <utility>

#include "compiler/import/cpfg/companions.h"
#include "compiler/import/cpfg/names.h"
#include "compiler/import/cpfg/reader.h"
#include "compiler/import/cpfg/source.h"
#include "compiler/import/cpfg/view.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

std::vector<ForeignModel> cpfg_models(const ForeignFile& file) {
    const std::string name(stem_of(file.sources.name(file.file)));
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

/// A line begins with "Lsystem:".
bool is_cpfg(std::string_view text) {
    return std::ranges::any_of(lines_of(text, 0, text.size()), [](const TextLine& line) {
        const std::string_view words = trimmed(line.text);
        return words.starts_with("Lsystem:") || words.starts_with("lsystem:");
    });
}

std::optional<Translation> translate_cpfg(const ForeignFile& file, const ForeignModel& model) {
    const std::optional<CpfgSource> source = read_cpfg_source(file);
    if (!source) return std::nullopt;
    const CpfgCompanions companions = find_cpfg_companions(file);
    const CpfgView view = read_cpfg_view(file, companions.view);
    CpfgNames names(file, *source, view);
    std::optional<CpfgSystem> system = read_cpfg_system(names);
    if (!system) return std::nullopt;
    const std::size_t errors = file.diagnostics.error_count();
    Translation out = write_cpfg_system(names, std::move(*system), model, companions.environment);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return out;
}

constexpr std::string_view cpfg_endings[] = {"l"};

} // namespace

Importer cpfg_importer() {
    return {"cpfg L-system", cpfg_endings, is_cpfg, "a line 'Lsystem: 1'", cpfg_models, translate_cpfg};
}

} // namespace graftal
