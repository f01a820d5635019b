#include "compiler/session/session.h"

#include <fmt/format.h>

#include "compiler/session/stage_clock.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Apart from steps and time.
bool same_options(const LowerOptions& a, const LowerOptions& b) {
    return a.set == b.set && a.preset == b.preset && a.in_place == b.in_place && a.seed == b.seed &&
           a.root == b.root && a.exact == b.exact && a.max_modules == b.max_modules &&
           a.run_from == b.run_from && a.max_objects == b.max_objects &&
           a.may_draw_nothing == b.may_draw_nothing && a.may_leave_out_colours == b.may_leave_out_colours &&
           a.may_be_orbit == b.may_be_orbit;
}

/// The depth as the stages after lowering read it: that of an L-system is spent.
std::optional<unsigned> steps_left(const LowerOptions& options, bool spent) {
    return spent ? std::nullopt : options.steps;
}

} // namespace

Session::Session(std::string path, const Files& files, Keep keep)
    : path_(std::move(path)), files_(files), keep_(keep) {}

Session::Session(std::string name, std::string text, Keep keep)
    : path_(std::move(name)), text_(std::move(text)), files_(no_files()), keep_(keep) {}

void Session::edit(std::string text) {
    text_ = std::move(text);
    ++edits_;
}

void Session::reload(bool textures_changed) {
    ++edits_;
    // A file that could not be used before may be there now.
    bool changed = textures_changed || lowered_.failed();
    for (FileId file = 1; file < sources_.size() && !changed; ++file) {
        if (sources_.original(file)) continue; // a translation of another
        std::string text;
        const std::string name(sources_.name(file));
        const Status status = files_.read(name, text);
        changed = !status.ok() || translator_.model_text(name, std::move(text)) != sources_.text(file);
    }
    for (const auto& [path, stamp] : meshes_)
        changed = changed || files_.stamp(path) != stamp;
    if (changed) ++file_changes_;
}

StageRuns Session::runs() const {
    StageRuns runs = runs_;
    runs.parsed = parsed_.parsed();
    return runs;
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
        compilation, [&] { return need_lowered(options, true, compilation) ? lowered_.value() : nullptr; });
}

std::shared_ptr<const AnalysedModel> Session::analysed(const StageOptions& options, Compilation& compilation,
                                                       bool for_report) {
    return unless_ended<AnalysedModel>(compilation, [&]() -> std::shared_ptr<const AnalysedModel> {
        if (!need_analysed(options, true, compilation)) return nullptr;
        if (!for_report && refuse_divergent(*analysed_.value(), compilation.diagnostics)) return nullptr;
        return analysed_.value();
    });
}

std::shared_ptr<const ViewedModel> Session::viewed(const StageOptions& options, Compilation& compilation) {
    return unless_ended<ViewedModel>(
        compilation, [&] { return need_viewed(options, compilation) ? viewed_.value() : nullptr; });
}

std::shared_ptr<const PreparedGraph> Session::prepared(const StageOptions& options,
                                                       Compilation& compilation) {
    return unless_ended<PreparedGraph>(compilation, [&] {
        const bool there = need_viewed(options, compilation) && need_prepared(options, compilation);
        return there ? prepared_.value() : nullptr;
    });
}

void Session::yield_memory() {
    if (keep_ != Keep::nothing) return;
    prepared_.drop();
    viewed_.drop();
    analysed_.drop();
    lowered_.drop();
}

bool Session::LowerKey::operator==(const LowerKey& other) const {
    const LowerOptions &a = options, &b = other.options;
    const bool same_source = source == other.source || source->text == other.source->text;
    if (!same_source || files != other.files || !same_options(a, b)) return false;
    // A time between steps is an error where there is none, and stands in for steps that are not given.
    const bool steps_count = reads_steps && other.reads_steps;
    const bool time_counts = (reads_time && other.reads_time) || !a.steps || !b.steps;
    const bool work_counts = limited_by_work && other.limited_by_work;
    return (!steps_count || a.steps == b.steps) && (!time_counts || a.time == b.time) &&
           (!work_counts || work_seconds == other.work_seconds);
}

bool Session::need_source(const StageOptions& options, Compilation& compilation) {
    SourceKey key{options.lower.root, edits_};
    if (source_key_ == key) return true;
    Diagnostics findings;
    Status status;
    ++runs_.source;
    std::optional<Source> source =
        text_ ? Source{path_, *text_} : read_source(path_, key.root, files_, translator_, findings, status);
    if (!source) { // asked again it may be there
        compilation.diagnostics = std::move(findings);
        compilation.status = std::move(status);
        return false;
    }
    source_ = std::make_shared<const Source>(std::move(*source));
    source_key_ = std::move(key);
    return true;
}

bool Session::need_lowered(const StageOptions& options, bool wanted, Compilation& compilation) {
    StageWork work = stage_work(options);
    const auto key_now = [&] { return LowerKey{source_, file_changes_, options.lower, work.left()}; };
    const auto up_to_date = [&] {
        return source_key_ == SourceKey{options.lower.root, edits_} && lowered_.is_of(key_now(), wanted);
    };
    const auto lower = [&] {
        if (!need_source(options, compilation)) return false;
        if (up_to_date()) return true;
        lowered_.run(key_now(), {}, [&](LowerKey& key, Diagnostics& findings) {
            sources_ = SourceMap();
            ++runs_.lowered;
            std::optional<LoweredModel> model = lower_source(
                *source_, options.lower,
                {look_at_texture_, charging(work), load_sky_picture_, translator_, &files_, &parsed_},
                sources_, findings);
            const Derivation* const derivation =
                model && model->notes.derivation ? &*model->notes.derivation : nullptr;
            key.reads_steps = reads_steps_ =
                !model || derivation || model->notes.word || model->notes.plant || model->notes.totals;
            key.reads_time = !model || (derivation && derivation->timed);
            key.limited_by_work = !model || model->notes.limited_by_work;
            if (model) meshes_ = model->notes.meshes;
            return model;
        });
        return true;
    };
    if (!up_to_date() && !StageClock(compilation.times).run("lower", lower)) return false;
    compilation.sources = sources_;
    compilation.diagnostics = lowered_.findings();
    return !lowered_.failed();
}

/// The lowered model for the next stage: its own where nobody else wants it.
LoweredModel Session::take_lowered() {
    if (keep_ == Keep::everything || lowered_.value().use_count() > 1) return *lowered_.value();
    LoweredModel model = std::move(*lowered_.value());
    lowered_.drop();
    return model;
}

bool Session::need_analysed(const StageOptions& options, bool wanted, Compilation& compilation) {
    Diagnostics findings;
    if (!check_pass(options.stop_after, findings)) {
        compilation.diagnostics = std::move(findings);
        return false;
    }
    if (!need_lowered(options, false, compilation)) return false;
    const auto key_now = [&] {
        return AnalyseKey{lowered_.serial(), options.stop_after, options.view.zoom.at};
    };
    if (!analysed_.is_of(key_now(), wanted)) {
        if (!need_lowered(options, true, compilation)) return false;
        if (lowered_.value()->notes.orbit) return false;
        analysed_.run(key_now(), lowered_.findings(), [&](const AnalyseKey&, Diagnostics& found) {
            ++runs_.analysed;
            LoweredModel lowered = take_lowered();
            StageWork work = stage_work(options, lowered.work_seconds);
            std::optional<AnalysedModel> model =
                analyse(std::move(lowered), options.view.zoom.at, {options.stop_after, after_pass_}, found,
                        compilation.times, charging(work));
            if (model) model->clouds = clouds_;
            return model;
        });
    }
    compilation.diagnostics = analysed_.findings();
    return !analysed_.failed();
}

bool Session::need_viewed(const StageOptions& options, Compilation& compilation) {
    if (!need_analysed(options, false, compilation)) return false;
    const auto key_now = [&] {
        return ViewKey{analysed_.serial(), steps_left(options.lower, reads_steps_), options.view,
                       cloud_rows(options.detail.work_seconds)};
    };
    if (!viewed_.is_of(key_now())) {
        if (!need_analysed(options, true, compilation)) return false;
        if (refuse_divergent(*analysed_.value(), compilation.diagnostics)) return false;
        viewed_.run(key_now(), analysed_.findings(), [&](const ViewKey& key, Diagnostics& findings) {
            const CloudPictures::Drawing drawing(*clouds_, key.cloud_rows, control_.cancel);
            ++runs_.viewed;
            return StageClock(compilation.times).run("frame", [&] {
                const std::optional<unsigned> steps = levels_of(*analysed_.value(), options.lower.steps);
                StageWork work = stage_work(options, analysed_.value()->work_seconds);
                return look_at(analysed_.value(), steps, options.view, findings, charging(work));
            });
        });
        if (keep_ == Keep::nothing) analysed_.drop();
    }
    compilation.diagnostics = viewed_.findings();
    return !viewed_.failed();
}

bool Session::need_prepared(const StageOptions& options, Compilation& compilation) {
    const ViewedModel& viewed = *viewed_.value();
    const AnalysedModel& model = *viewed.model;
    const DetailOptions detail = resolved(options.detail, viewed);
    if (refuse_endless(model.graph, model.components, detail, compilation.diagnostics)) return false;
    const bool zoomed = options.view.zoom.active();
    PrepareKey key{analysed_.serial(), zoomed ? viewed_.serial() : 0, detail.preparing()};
    if (prepared_.is_of(key)) return true;
    prepared_.run(std::move(key), {}, [&](const PrepareKey&, Diagnostics&) {
        ++runs_.prepared;
        StageWork work = stage_work(options, model.work_seconds);
        return std::optional(prepare_graph(model.graph, model.components, model.bounds, detail.preparing(),
                                           charging(work), after_pass_));
    });
    return true;
}

} // namespace graftal
