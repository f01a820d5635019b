#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "compiler/lower/language.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// The trees of model files. Each text is parsed once, for however many lowerings: one with other parameters
/// parses nothing.
class ParsedFiles {
  public:
    /// The tree of a file in a language, valid until the same number names another text. Its findings go to
    /// `diagnostics`, at each call. Requires the same table of languages at each call.
    const ModelTree& tree(const Language& language, FileId file, const SourceMap& sources,
                          std::span<const Language> languages, Diagnostics& diagnostics);

    /// Number of texts that were parsed.
    std::uint64_t parsed() const { return parsed_; }

  private:
    struct Entry {
        SourceMap sources; ///< holds the text, which the tree has views of
        const Language* language = nullptr;
        std::unique_ptr<const ModelTree> tree;
        Diagnostics findings;
    };
    std::map<FileId, Entry> entries_;
    std::uint64_t parsed_ = 0;
};

} // namespace graftal
