#include "compiler/session/session.h"

#include <fmt/format.h>

#include "compiler/session/stage_clock.h"
#include "compiler/support/file.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Apart from steps and time.
bool same_options(const LowerOptions& a, const LowerOptions& b) {
    return a.set == b.set && a.seed == b.seed && a.root == b.root && a.exact == b.exact &&
           a.max_modules == b.max_modules && a.run_from == b.run_from && a.max_objects == b.max_objects &&
           a.may_draw_nothing == b.may_draw_nothing && a.may_leave_out_colours == b.may_leave_out_colours &&
           a.may_be_orbit == b.may_be_orbit;
}

/// The depth as the stages after lowering read it: that of an L-system is spent.
std::optional<unsigned> steps_left(const LowerOptions& options, bool spent) {
    return spent ? std::nullopt : options.steps;
}

} // namespace

Session::Session(std::string path, Keep keep) : path_(std::move(path)), keep_(keep) {}

Session::Session(std::string name, std::string text, Keep keep)
    : path_(std::move(name)), text_(std::move(text)), keep_(keep) {}

void Session::edit(std::string text) {
    text_ = std::move(text);
    ++edits_;
}

void Session::reload(bool textures_changed) {
    ++edits_;
    // A file that could not be used before may be there now.
    bool changed = textures_changed || lowered_.failed;
    for (FileId file = 1; file < sources_.size() && !changed; ++file) {
        if (sources_.original(file)) continue; // a translation of another
        std::string text;
        const std::string name(sources_.name(file));
        const Status status = read_text(name, text);
        changed = !status.ok() || translator_.model_text(name, std::move(text)) != sources_.text(file);
    }
    for (const auto& [path, stamp] : meshes_)
        changed = changed || stamp_of(path) != stamp;
    if (changed) ++file_changes_;
}

template<typename Value, typename Work>
std::shared_ptr<const Value> Session::unless_ended(Compilation& compilation, const Work& work) {
    try {
        return work();
    } catch (const Cancelled&) {
        compilation.status = Status::failure("interrupted");
    } catch (const OutOfWork& fault) {
        compilation.sources = sources_;
        compilation.diagnostics
            .error(Span{0, 0, 0},
                   fmt::format("the model takes more than {} seconds of work before it can be drawn: graftal "
                               "gave it up in the stage '{}'",
                               shortest(fault.limit_seconds()), fault.stage()))
            .with_hint("allow more with --work, or ask for less: fewer steps, copies, or kinds of parts");
    }
    return nullptr;
}

Control Session::charging(StageWork& work) const {
    Control control = control_;
    control.work = &work;
    return control;
}

std::shared_ptr<const LoweredModel> Session::lowered(const StageOptions& options, Compilation& compilation) {
    return unless_ended<LoweredModel>(
        compilation, [&] { return need_lowered(options, true, compilation) ? lowered_.value : nullptr; });
}

std::shared_ptr<const AnalysedModel> Session::analysed(const StageOptions& options, Compilation& compilation,
                                                       bool for_report) {
    return unless_ended<AnalysedModel>(compilation, [&]() -> std::shared_ptr<const AnalysedModel> {
        if (!need_analysed(options, true, compilation)) return nullptr;
        if (!for_report && refuse_divergent(*analysed_.value, compilation.diagnostics)) return nullptr;
        return analysed_.value;
    });
}

std::shared_ptr<const ViewedModel> Session::viewed(const StageOptions& options, Compilation& compilation) {
    return unless_ended<ViewedModel>(
        compilation, [&] { return need_viewed(options, compilation) ? viewed_.value : nullptr; });
}

std::shared_ptr<const PreparedCut> Session::prepared(const StageOptions& options, Compilation& compilation) {
    return unless_ended<PreparedCut>(compilation, [&] {
        const bool there = need_viewed(options, compilation) && need_prepared(options, compilation);
        return there ? prepared_.value : nullptr;
    });
}

std::shared_ptr<const CompiledModel> Session::compiled(const StageOptions& options,
                                                       Compilation& compilation) {
    return unless_ended<CompiledModel>(compilation, [&] {
        const bool there = need_viewed(options, compilation) && need_compiled(options, compilation);
        return there ? compiled_.value : nullptr;
    });
}

void Session::yield_memory() {
    if (keep_ == Keep::everything) return;
    compiled_.value.reset();
    if (keep_ == Keep::for_views) return;
    prepared_.value.reset();
    viewed_.value.reset();
    analysed_.value.reset();
    lowered_.value.reset();
}

bool Session::same_inputs(const LowerKey& before, const LowerKey& now) const {
    if (before.source != now.source || before.files != now.files ||
        !same_options(before.options, now.options))
        return false;
    const LowerOptions &a = before.options, &b = now.options;
    // A time between steps is an error where there is none, and stands in for steps that are not given.
    const bool time_counts = reads_time_ || !a.steps || !b.steps;
    return (!reads_steps_ || a.steps == b.steps) && (!time_counts || a.time == b.time) &&
           (!limited_by_work_ || before.work_seconds == now.work_seconds);
}

template<typename Of> void Session::restart(Of& slot, bool same) {
    if (!same) slot.serial = ++serials_;
    slot.key.reset();
    slot.value.reset();
    slot.failed = false;
    slot.findings = Diagnostics();
}

template<typename Of, typename Key, typename Value>
void Session::finish(Of& slot, Key key, std::optional<Value> value, Diagnostics findings) {
    if (value) slot.value = std::make_shared<Value>(std::move(*value));
    slot.failed = !slot.value;
    slot.findings = std::move(findings);
    slot.key = std::move(key);
}

bool Session::need_source(const StageOptions& options, Compilation& compilation) {
    SourceKey key{options.lower.root, edits_};
    if (source_.key == key) return true;
    Diagnostics findings;
    Status status;
    ++runs_.source;
    std::optional<Source> source =
        text_ ? Source{path_, *text_} : read_source(path_, key.root, translator_, findings, status);
    if (!source) { // asked again it may be there
        compilation.diagnostics = std::move(findings);
        compilation.status = std::move(status);
        return false;
    }
    restart(source_, source_.value && source_.value->text == source->text);
    finish(source_, std::move(key), std::move(source), {});
    return true;
}

bool Session::need_lowered(const StageOptions& options, bool wanted, Compilation& compilation) {
    StageWork work = stage_work(options);
    const auto up_to_date = [&] {
        if (!source_.key || *source_.key != SourceKey{options.lower.root, edits_}) return false;
        const LowerKey key{source_.serial, file_changes_, options.lower, work.left()};
        return lowered_.key && same_inputs(*lowered_.key, key) &&
               (lowered_.value || lowered_.failed || !wanted);
    };
    const auto lower = [&] {
        if (!need_source(options, compilation)) return false;
        if (up_to_date()) return true;
        LowerKey key{source_.serial, file_changes_, options.lower, work.left()};
        restart(lowered_, lowered_.key && same_inputs(*lowered_.key, key));
        sources_ = SourceMap();
        Diagnostics findings;
        ++runs_.lowered;
        std::optional<LoweredModel> model = lower_source(
            *source_.value, options.lower,
            {look_at_texture_, charging(work), on_file_, load_sky_picture_, translator_}, sources_, findings);
        const Derivation* const derivation =
            model && model->notes.derivation ? &*model->notes.derivation : nullptr;
        reads_steps_ = !model || derivation;
        reads_time_ = !model || (derivation && derivation->timed);
        limited_by_work_ = !model || model->notes.limited_by_work;
        if (model) meshes_ = model->notes.meshes;
        finish(lowered_, std::move(key), std::move(model), std::move(findings));
        return true;
    };
    if (!up_to_date() && !StageClock(compilation.times).run("lower", lower)) return false;
    compilation.sources = sources_;
    compilation.diagnostics = lowered_.findings;
    return !lowered_.failed;
}

bool Session::need_analysed(const StageOptions& options, bool wanted, Compilation& compilation) {
    Diagnostics findings;
    if (!check_pass(options.stop_after, findings)) {
        compilation.diagnostics = std::move(findings);
        return false;
    }
    if (!need_lowered(options, false, compilation)) return false;
    AnalyseKey key{lowered_.serial, options.stop_after, options.view.zoom.at};
    const bool same = analysed_.key == key;
    if (!same || (wanted && !analysed_.value && !analysed_.failed)) {
        if (!need_lowered(options, true, compilation)) return false;
        if (lowered_.value->notes.orbit) return false;
        restart(analysed_, same);
        LoweredModel lowered;
        if (keep_ == Keep::everything || lowered_.value.use_count() > 1) {
            lowered = *lowered_.value;
        } else {
            lowered = std::move(*lowered_.value);
            lowered_.value.reset();
        }
        findings = lowered_.findings;
        compilation.diagnostics = findings;
        ++runs_.analysed;
        StageWork work = stage_work(options, lowered.work_seconds);
        std::optional<AnalysedModel> model =
            analyse(std::move(lowered), options.view.zoom.at, {options.stop_after, after_pass_}, findings,
                    compilation.times, charging(work));
        if (model) model->clouds = clouds_;
        finish(analysed_, std::move(key), std::move(model), std::move(findings));
    }
    compilation.diagnostics = analysed_.findings;
    return !analysed_.failed;
}

bool Session::need_viewed(const StageOptions& options, Compilation& compilation) {
    if (!need_analysed(options, false, compilation)) return false;
    ViewKey key{analysed_.serial, steps_left(options.lower, reads_steps_), options.view};
    const bool same = viewed_.key == key;
    if (!same || (!viewed_.value && !viewed_.failed)) {
        if (!need_analysed(options, true, compilation)) return false;
        if (refuse_divergent(*analysed_.value, compilation.diagnostics)) return false;
        restart(viewed_, same);
        Diagnostics findings = analysed_.findings;
        ++runs_.viewed;
        std::optional<ViewedModel> model = StageClock(compilation.times).run("frame", [&] {
            const std::optional<unsigned> steps = levels_of(*analysed_.value, options.lower.steps);
            return look_at(analysed_.value, steps, options.view, findings);
        });
        if (keep_ == Keep::nothing) analysed_.value.reset();
        finish(viewed_, std::move(key), std::move(model), std::move(findings));
    }
    compilation.diagnostics = viewed_.findings;
    return !viewed_.failed;
}

Session::PrepareKey Session::prepare_key(const StageOptions& options) const {
    const bool zoomed = options.view.zoom.active();
    return {analysed_.serial, zoomed ? viewed_.serial : 0,
            resolved(options.detail, *viewed_.value).preparing()};
}

bool Session::need_prepared(const StageOptions& options, Compilation& compilation) {
    const ViewedModel& viewed = *viewed_.value;
    const AnalysedModel& model = *viewed.model;
    const DetailOptions detail = resolved(options.detail, viewed);
    if (refuse_endless(model.graph, model.components, detail, compilation.diagnostics)) return false;
    PrepareKey key = prepare_key(options);
    const bool same = prepared_.key == key;
    if (same && prepared_.value) return true;
    restart(prepared_, same);
    ++runs_.prepared;
    StageWork work = stage_work(options, model.work_seconds);
    finish(prepared_, std::move(key),
           std::optional(prepare_cut(model.graph, model.components, model.bounds, detail.preparing(),
                                     charging(work), after_pass_)),
           {});
    return true;
}

bool Session::need_compiled(const StageOptions& options, Compilation& compilation) {
    const auto key = [&] {
        return CompileKey{prepared_.serial, viewed_.serial, options.detail, options.cut};
    };
    const bool same = prepared_.key == prepare_key(options) && compiled_.key == key();
    if (!same || (!compiled_.value && !compiled_.failed)) {
        const auto cut = [&] {
            if (!need_prepared(options, compilation)) return false;
            restart(compiled_, same);
            const ViewedModel& viewed = *viewed_.value;
            const DetailOptions detail = resolved(options.detail, viewed);
            Diagnostics findings = viewed_.findings;
            ++runs_.compiled;
            std::optional<Cut> made = cut_prepared(viewed.model->graph, *prepared_.value, viewed.view, detail,
                                                   findings, options.cut, control_);
            if (keep_ == Keep::nothing) prepared_.value.reset();
            std::optional<CompiledModel> model;
            if (made) model = CompiledModel{viewed.model, viewed.steps, viewed.view, std::move(*made)};
            finish(compiled_, key(), std::move(model), std::move(findings));
            return true;
        };
        if (!StageClock(compilation.times).run("cut", cut)) return false;
    }
    compilation.diagnostics = compiled_.findings;
    return !compiled_.failed;
}

} // namespace graftal
