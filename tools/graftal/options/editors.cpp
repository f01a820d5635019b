#include "tools/graftal/options/editors.h"

namespace graftal {

void add_format(CLI::App& app, Options& options) {
    app.add_option("MODEL", options.operands, "Model files, or - for standard input")
        ->required()
        ->expected(1, -1)
        ->type_name("");
    app.add_flag("--check", options.check,
                 "Write nothing: name the files that are laid out otherwise; the exit status is 1 if there "
                 "are any");
    app.add_flag("-q,--quiet", options.quiet, "Print only errors and warnings");
    app.footer(
        "Blocks are indented, blanks and empty lines are those that the layout needs. Comments stay, and\n"
        "so do columns. The model means the same. A model on standard input goes to standard output.\n"
        "Examples:\n"
        "  graftal format fern.rifs\n"
        "  graftal format --check models/*.inst");
}

void add_lsp(CLI::App& app, Options&) {
    app.add_flag("--stdio")->description(
        "Speak on standard input and output, as the command always does: some editors ask for it");
    app.footer(
        "Editors start this command, and speak the Language Server Protocol with it on standard input\n"
        "and output: docs/editors.md has configurations.\n"
        "Example:\n"
        "  graftal lsp");
}

} // namespace graftal
