#include <fmt/format.h>

#include "compiler/editing/format.h"
#include "compiler/languages/languages.h"
#include "compiler/support/printable.h"
#include "compiler/support/text_encoding.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// The language of a text from standard input has no name to tell it by.
std::string name_with_ending(const std::string& path, const std::string& text) {
    if (path != "-") return path;
    SourceMap sources;
    const FileId file = sources.add(std::string(standard_input), text);
    const Language* const language = language_of(file, sources, languages());
    return fmt::format("{}.{}", standard_input, language->extension);
}

int format_one(const Options& options, const std::string& path) {
    Compilation compilation;
    std::string bytes;
    compilation.status = disk_files().read(path, bytes);
    if (!compilation.status.ok()) return conclude(options, compilation);
    const std::string text = decoded_text(bytes, OtherBytes::kept);
    const Document document(name_with_ending(path, text), text);
    compilation.sources = document.sources();
    compilation.diagnostics.add(document.findings());
    if (!document.language())
        compilation.diagnostics
            .error({0, 0, 0}, "this file is in none of the languages that graftal lays out")
            .with_hint(fmt::format(
                "the names of models end in {}; 'graftal import' translates those of other programs",
                extensions(languages())));
    if (compilation.diagnostics.has_errors()) return conclude(options, compilation);
    const std::string laid_out = applied(text, format(document));
    if (path == "-" && !options.check) return print_output(laid_out);
    if (laid_out == bytes) return exit_done;
    if (options.check) {
        if (!options.quiet) print_output(escaped(path) + "\n");
        return exit_fault;
    }
    compilation.status = write_text(path, laid_out);
    return conclude(options, compilation);
}

} // namespace

int run_format(const Options& options) {
    int worst = exit_done;
    for (const std::string& path : options.operands) {
        const int status = format_one(options, path);
        // A fault of a model outranks one of the environment.
        if (worst != exit_fault && status != exit_done) worst = status;
    }
    return worst;
}

} // namespace graftal
