#include "compiler/lower/parsed_files.h"

#include <utility>

namespace graftal {

const ModelTree& ParsedFiles::tree(const Language& language, FileId file, const SourceMap& sources,
                                   std::span<const Language> languages, Diagnostics& diagnostics) {
    Entry& entry = entries_[file];
    const bool known = entry.tree && entry.language == &language &&
                       entry.sources.name(file) == sources.name(file) &&
                       entry.sources.text(file) == sources.text(file);
    if (!known) {
        ++parsed_;
        entry = {.sources = sources, .language = &language, .tree = nullptr, .findings = {}};
        entry.tree = parse_model(language, file, entry.sources, languages, entry.findings);
    }
    diagnostics.add(entry.findings);
    return *entry.tree;
}

} // namespace graftal
