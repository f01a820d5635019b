#include <algorithm>

#include <fmt/format.h>

#include "compiler/graph/text/emit_dot.h"
#include "compiler/graph/text/print.h"
#include "compiler/graph/text/print_rifs.h"
#include "compiler/rifs/orbit_model.h"
#include "compiler/support/printable.h"
#include "runtime/system/file.h"
#include "runtime/system/interruption.h"
#include "runtime/system/process.h"
#include "runtime/system/temporary_directory.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

std::string verdict_text(const Contraction& contraction) {
    return contraction.verdict == Verdict::acyclic
               ? std::string("nothing in it contains itself")
               : fmt::format("it contains itself and shrinks: to {:.6g} of its size or less per instance",
                             contraction.rate());
}

int check_one(const Options& options, const std::string& path) {
    Compilation compilation;
    StageOptions compile = inspecting(options, true);
    compile.lower.may_be_orbit = true;
    CommandSession session(options, path);
    std::shared_ptr<const OrbitModel> orbit;
    if (const auto lowered = session.lowered(compile, compilation)) orbit = lowered->notes.orbit;
    std::shared_ptr<const AnalysedModel> model;
    const bool failed = !compilation.status.ok() || compilation.diagnostics.has_errors();
    if (!orbit && !failed) model = session.analysed(compile, compilation);
    const int status = conclude(options, compilation);
    if (status == exit_done && orbit && !options.quiet)
        return print_output(fmt::format("{}: ok, an orbit of {} map{}: 'graftal points' draws it\n",
                                        escaped(path), orbit->maps.size(),
                                        orbit->maps.size() == 1 ? "" : "s"));
    if (status != exit_done || !model || options.quiet) return status;
    return print_output(fmt::format("{}: ok, {}\n", escaped(path), verdict_text(model->contraction)));
}

/// DOT -> SVG by Graphviz's own program, which writes beside the output and is renamed.
Status write_svg(const std::string& dot, const std::string& output, const CancelFlag& cancel) {
    if (!find_program("dot"))
        return Status::failure("cannot find the program 'dot'; install it with 'apt-get install graphviz'");
    TemporaryDirectory directory;
    Status status = directory.create();
    const std::string source = directory.path() + "/graph.dot";
    if (status.ok()) status = write_text(source, dot);
    if (!status.ok()) return status;

    PendingFile pending(output);
    if (!pending.status().ok()) return pending.status();
    std::string messages;
    ProcessOptions options;
    options.cancel = cancel;
    options.arguments = {"dot", "-Tsvg", "-o", pending.temporary_path(), source};
    options.on_error_text = [&](std::string_view text) { messages += text; };
    const ProcessResult result = run_process(options);
    if (!result.status.ok()) return result.status;
    if (result.cancelled) return Status::failure("interrupted");
    if (!result.succeeded())
        return Status::failure(fmt::format("'dot' failed with status {}: {}", result.exit_code, messages));
    return pending.commit();
}

/// The string of an L-system after its steps.
int print_word(const Options& options) {
    Compilation compilation;
    StageOptions compile = inspecting(options, true);
    compile.lower.may_be_orbit = true;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const LoweredModel> lowered = session.lowered(compile, compilation);
    const bool is_lsys = lowered && lowered->notes.word;
    if (lowered && !is_lsys && compilation.status.ok() && !compilation.diagnostics.has_errors())
        compilation.diagnostics.error(Span(), "only L-systems have a word");
    const int status = conclude(options, compilation);
    return status == exit_done && is_lsys ? print_output(*lowered->notes.word + "\n") : status;
}

} // namespace

int run_check(const Options& options) {
    int worst = exit_done;
    for (const std::string& path : options.operands) {
        const int status = check_one(options, path);
        // A fault of a model outranks one of the environment.
        if (worst != exit_fault && status != exit_done) worst = status;
    }
    return worst;
}

int run_print(const Options& options) {
    if (options.render.compile.lower.in_place == LowerOptions::InPlace::word) return print_word(options);
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const AnalysedModel> model =
        session.analysed(inspecting(options), compilation, true);
    std::optional<std::string> rifs;
    if (model && options.as_rifs) {
        std::string why;
        rifs = print_rifs(model->graph, model->components, why);
        if (!rifs)
            compilation.diagnostics
                .error(model->graph.objects[model->graph.root].span,
                       "this model is no recurrent iterated function system: " + why)
                .with_hint("in an L-system 'steps infinite' draws the limit, which may be one");
    }
    const int status = conclude(options, compilation);
    if (!model || status != exit_done) return status;
    return print_output(rifs ? *rifs : print(model->graph));
}

int run_graph(const Options& options) {
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const AnalysedModel> model =
        session.analysed(inspecting(options), compilation, true);
    const Interruption interruption;
    if (model) {
        const std::string dot = emit_dot(model->graph, model->components);
        compilation.status = options.render.output.ends_with(".svg")
                                 ? write_svg(dot, options.render.output, interruption.flag())
                                 : write_text(options.render.output, dot);
    }
    return conclude(options, compilation, interruption.signal());
}

} // namespace graftal
