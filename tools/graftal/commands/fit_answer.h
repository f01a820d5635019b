#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "runtime/system/file.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/report.h"

namespace graftal {

/// Writes what a kind of `graftal fit` found, and tells of it, also of what an interruption left. The exit
/// status. `found`: null after an error. Requires Found::text, that of the file.
template<typename Found>
int answer_fit(const Options& options, const std::optional<Found>& found,
               nlohmann::ordered_json (*json)(const Options&, const Found&),
               std::string (*report)(const Options&, const Found&), const Interruption& interruption,
               Compilation& compilation) {
    if (found) compilation.status = write_text(options.render.output, found->text);
    const int status = conclude(options, compilation, interruption.signal());
    if (!found || !compilation.status.ok()) return status;
    if (options.json) {
        // Names of files need not be UTF-8.
        const std::string text =
            json(options, *found).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
        const int printed = print_output(text + "\n");
        return status == exit_done ? printed : status;
    }
    if (!options.quiet) say(report(options, *found));
    return status;
}

} // namespace graftal
