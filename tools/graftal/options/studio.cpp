#include "tools/graftal/options/studio.h"

#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/values.h"

namespace graftal {

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
