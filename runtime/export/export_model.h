#pragma once

#include <optional>
#include <string>

#include "runtime/export/formats.h"
#include "runtime/render/picture_session.h"

namespace graftal {

struct ExportModelOptions {
    StageOptions compile; ///< its error counts where nothing else ends the model, or if it `error_asked`
    bool error_asked = false;
    ExportOptions file;
};

/// Writes the model of the session in the format that the output's ending names. Returns what was written, or
/// nothing, after an error or with a failed status. Requires an ending that find_export_format() knows.
std::optional<std::string> export_model(PictureSession& session, const ExportModelOptions& options,
                                        Compilation& compilation);

} // namespace graftal
