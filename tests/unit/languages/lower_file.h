#pragma once

#include <string>
#include <utility>

#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"

namespace graftal::test {

/// lower_text() of a file, or of a model in one.
inline LoweredText lower_file(const std::string& path, const LowerOptions& options, SourceMap& sources,
                              Diagnostics& diagnostics, Status& status,
                              const LowerHelp& help = {.files = &disk_files()}) {
    std::string text;
    status = help.files->read(help.translator.model_path(path).file, text);
    return status.ok() ? lower_text(path, std::move(text), options, sources, diagnostics, help)
                       : LoweredText{};
}

} // namespace graftal::test
