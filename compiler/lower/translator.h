#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/files.h"
#include "compiler/support/source.h"

namespace graftal {

/// A model as a command or a `use` names it.
struct ModelPath {
    std::string file;
    std::string model; ///< in a foreign file; "" where only the file is named
};

/// The context in which a foreign file is read.
struct TranslateOptions {
    std::string root{}; ///< files beside it must lie in this folder; "": anywhere
    const Files* files = &no_files();
    std::uint64_t seed = 0; ///< of random numbers that a translation draws
};

/// The compiler's door to the files of other programs. Its caller hands in the functions;
/// import/importers.h has those that know formats. No function is null.
struct Translator {
    /// The file and the model that a path names.
    ModelPath (*model_path)(std::string_view path);
    /// The text of a model's file from its bytes.
    std::string (*model_text)(std::string_view file_name, std::string bytes);
    /// The text in one of our languages of a file: the file itself, or the translation of the model of this
    /// name in it, which becomes a file of `sources`. Nothing after an error. Throws OutOfWork where the
    /// meter allows no more.
    std::optional<FileId> (*own_text)(FileId file, std::string_view model, SourceMap& sources,
                                      Diagnostics& diagnostics, const TranslateOptions& options,
                                      WorkMeter* meter);
};

/// The translator that knows no foreign format: each file is in one of our languages.
Translator no_translator();

} // namespace graftal
