// The command line: any words give options, help or a complaint, and options that a command can run with.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/check.h"
#include "tests/fuzz/words.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    const auto words = fuzz::words_of({reinterpret_cast<const char*>(data), size});
    const auto arguments = fuzz::arguments_of(words);
    const ParsedCommandLine parsed = parse_command_line(static_cast<int>(arguments.size()), arguments.data());
    if (!parsed.options) {
        GRAFTAL_CHECK(parsed.exit_status == exit_done || parsed.exit_status == exit_usage,
                      "command line fuzzer: help or a complaint");
        return 0;
    }
    const Options& options = *parsed.options;
    if (std::string_view(options.command->name) == "farm") {
        GRAFTAL_CHECK(!options.farm.folder.empty(), "command line fuzzer: a job");
        return 0;
    }
    GRAFTAL_CHECK(!options.operands.empty(), "command line fuzzer: a model");
    GRAFTAL_CHECK(!options.render.tile || options.render.tile->lies_in(options.render.compile.view.size),
                  "command line fuzzer: a part of the picture");
    GRAFTAL_CHECK(options.render.compile.view.size.width > 0 && options.render.compile.view.size.height > 0,
                  "command line fuzzer: a picture has pixels");
    GRAFTAL_CHECK(options.render.compile.detail.error_px >= 0 &&
                      options.render.compile.detail.work_seconds > 0,
                  "command line fuzzer: budgets");
    return 0;
}
