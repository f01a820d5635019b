#include "tools/graftal/options/editors.h"

#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/values.h"

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

void add_studio(CLI::App& app, Options& options) {
    app.add_option_function<std::string>(
           "MODEL", [&options](const std::string& model) { options.operands = {model}; },
           model_file_help() + "; without one, the studio opens an example")
        ->type_name("");
    app.add_flag_callback(
        "--no-browser", [&options] { options.studio.browser = false; },
        "Print the page's address, and open no browser");
    add_value(
        app, "--port", "N", "Port of the page (default: any that is free)", "a whole number from 1 to 65535",
        [](const std::string& text) { return parse_whole(text, 1, 65535); },
        [&](std::uint64_t port) { options.studio.port = static_cast<std::uint16_t>(port); });
    app.add_option(
           "--bind", options.studio.address,
           "IP address on which other machines reach the page; whoever has the page's whole address can "
           "use it (default 127.0.0.1: this machine only)")
        ->type_name("ADDRESS");
    add_bytes(app, "--memory", "Memory that all pages may use together; suffixes K M G (default 4G)",
              [&](std::uint64_t bytes) { options.studio.memory_bytes = bytes; });
    app.add_flag("-q,--quiet", options.quiet, "Print only the address, errors and warnings");
    app.footer(
        "The page's address holds a random token: nobody reaches the page without it. Ctrl-C ends the\n"
        "studio.\n"
        "Examples:\n"
        "  graftal studio scenes/ifs/fern.rifs\n"
        "  graftal studio tree.lsys --no-browser --port 8000");
}

} // namespace graftal
