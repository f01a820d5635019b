#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include "runtime/studio/server/studio_server.h"
#include "runtime/system/interruption.h"
#include "runtime/system/process.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"
#include "tools/graftal/studio_home.h"

namespace graftal {

namespace {

/// Shows the page in the person's browser, if there is one.
void open_browser(const std::string& url, const CancelFlag& cancel) {
    const bool has_screen = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
    const std::optional<std::string> program = has_screen ? find_program("xdg-open") : std::nullopt;
    if (!program) return;
    ProcessOptions options;
    options.arguments = {*program, url};
    options.cancel = cancel;
    run_process(options);
}

} // namespace

int run_studio(const Options& options) {
    auto model = std::make_shared<StudioModel>();
    const Interruption interruption;
    Compilation compilation;
    compilation.status = read_studio_model(options.operands.empty() ? "" : options.operands.front(), *model);
    if (!compilation.status.ok()) return conclude(options, compilation);
    StudioServer server({.address = options.studio.address, .port = options.studio.port, .make_home = [&] {
                             return std::make_unique<ProgramHome>(model);
                         }});
    compilation.status = server.open();
    if (!compilation.status.ok()) return conclude(options, compilation);
    const std::string url = server.url();
    if (const int status = print_output(url + "\n"); status != exit_done) return status;
    if (!options.quiet) say("graftal: open this address in a browser; Ctrl-C ends the studio\n");
    std::thread browser;
    if (options.studio.browser) browser = std::thread([&] { open_browser(url, interruption.flag()); });
    server.run(interruption.flag());
    if (browser.joinable()) browser.join();
    return exit_done;
}

} // namespace graftal
