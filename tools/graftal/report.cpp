#include "tools/graftal/report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/graph/text/print.h"
#include "compiler/support/check.h"
#include "compiler/support/printable.h"
#include "runtime/system/file.h"
#include "runtime/system/memory_limit.h"
#include "tools/graftal/commands.h"

namespace graftal {

namespace {

/// Names of files come from outside; what follows one in a message must still be seen.
constexpr std::size_t longest_complaint = 2000;

} // namespace

void say(const std::string& text) {
    std::fputs(escaped_lines(text).c_str(), stderr);
}

void complain(std::string_view text) {
    say(fmt::format("graftal: {}\n", escaped(text, longest_complaint)));
}

void print_findings(const Options& options, const Compilation& compilation) {
    say(compilation.diagnostics.render(compilation.sources, options.quiet));
    if (!compilation.status.ok()) complain(compilation.status.message());
    if (options.time)
        for (const StageTime& time : compilation.times)
            say(fmt::format("{:>10.3f} s  {}\n", time.seconds, time.stage));
}

int conclude(const Options& options, const Compilation& compilation, int signal) {
    print_findings(options, compilation);
    if (signal) return 128 + signal;
    if (compilation.diagnostics.has_errors()) return exit_fault;
    return compilation.status.ok() ? exit_done : exit_environment;
}

bool same_place(const std::string& a, const std::string& b) {
    std::error_code error;
    const auto place = std::filesystem::weakly_canonical(a, error);
    return !error && place == std::filesystem::weakly_canonical(b, error) && !error;
}

bool refuse_own_file(const Options& options, const std::vector<std::string>& uses, Compilation& compilation) {
    const std::string& output = options.render.output;
    if (!options.output_is_default ||
        std::ranges::none_of(uses, [&](const std::string& path) { return same_place(path, output); }))
        return false;
    compilation.diagnostics
        .error(Span(), fmt::format("the model uses '{}', whose name its picture would have", output))
        .with_hint("name the picture with '-o FILE'");
    return true;
}

int conclude_out_of_memory(const std::bad_alloc& fault) noexcept {
    const auto* known = dynamic_cast<const OutOfMemory*>(&fault);
    char text[400];
    int length = std::snprintf(text, sizeof text, "graftal: %s", known ? known->what() : "out of memory");
    if (memory_limit() > 0)
        length +=
            std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length),
                          ": graftal may use %llu MiB itself; allow more with --memory, or draw less with "
                          "--steps or --error",
                          static_cast<unsigned long long>(memory_limit() >> 20));
    text[length++] = '\n';
    if (::write(STDERR_FILENO, text, static_cast<std::size_t>(length)) < 0)
        return exit_environment; // standard error is closed
    return memory_limit() > 0 ? exit_fault : exit_environment;
}

StageOptions inspecting(const Options& options, bool shapes_only) {
    StageOptions compile = options.render.compile;
    compile.detail.work_seconds = options.render.work_seconds.value_or(inspecting_seconds);
    compile.lower.may_leave_out_colours = shapes_only;
    compile.draws = false;
    return compile;
}

int print_output(std::string_view text) {
    const Status status = write_text("-", text);
    if (status.ok()) return exit_done;
    complain(status.message());
    return exit_environment;
}

CommandSession::CommandSession(const Options& options, const std::string& path, Keep keep, const Files& files)
    : PictureSession(path, keep, files) {
    if (options.dump_after.empty()) return;
    after_each_pass([wanted = options.dump_after](const Pass& pass, const Graph& graph) {
        if (wanted == "all" || wanted == pass.name)
            say(fmt::format("// after {}\n{}", pass.name, print(graph)));
    });
}

} // namespace graftal
