#include "runtime/export/export_animation.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "runtime/export/formats/usd_text.h"
#include "runtime/export/output_file.h"
#include "runtime/render/stopwatch.h"

namespace graftal {

namespace {

/// A state of the model, shown in the frames from `first` to before `end`.
struct State {
    std::size_t first = 0, end = 0;
    std::string file; ///< beside NAME.usda
};

/// Whether both files can be read and hold the same bytes.
bool are_equal(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::ifstream left(a, std::ios::binary), right(b, std::ios::binary);
    using Bytes = std::istreambuf_iterator<char>;
    return left && right && std::equal(Bytes(left), Bytes(), Bytes(right), Bytes());
}

/// Writes what shows them one after the other. Frames count from 1 here.
Status write_frames(const AnimateOptions& animate, const std::vector<State>& states, const View& view,
                    double unit_mm) {
    bool too_large = false;
    OutputFile file(animate.output, UINT64_MAX, too_large);
    if (!file.ok()) return file.status();
    file.print(
        "#usda 1.0\n(\n defaultPrim = \"model\"\n metersPerUnit = {}\n upAxis = \"Y\"\n startTimeCode = 1\n "
        "endTimeCode = {}\n timeCodesPerSecond = {}\n framesPerSecond = {}\n)\n\ndef Xform \"model\"\n{{\n",
        shortest(unit_mm / 1000), animate.frames, shortest(animate.rate.per_second()),
        shortest(animate.rate.per_second()));
    std::vector<std::pair<std::string, std::string>> of_scene{{"Camera", "camera"}};
    for (std::size_t i = 0; i < view.lights.size(); ++i)
        of_scene.emplace_back("", fmt::format("light_{}", i));
    if (view.sky_light) of_scene.emplace_back("", "sky");
    for (const auto& [type, name] : of_scene)
        file.print(" def {}{}\"{}\" (\n  prepend references = {}</model/{}>\n )\n {{\n }}\n", type,
                   type.empty() ? "" : " ", name, usd_asset(states.back().file), name);
    for (std::size_t i = 0; i < states.size(); ++i) {
        const State& state = states[i];
        file.print(" def Xform \"state_{}\" (\n  prepend references = {}\n )\n {{\n", i + 1,
                   usd_asset(state.file));
        file.text("  token visibility.timeSamples = {");
        if (state.first > 0) file.print(" {}: \"invisible\",", state.first);
        file.print(" {}: \"inherited\",", state.first + 1);
        if (state.end < animate.frames) file.print(" {}: \"invisible\",", state.end + 1);
        file.text(" }\n");
        for (const auto& [type, name] : of_scene)
            file.print("  over \"{}\" (\n   active = false\n  )\n  {{\n  }}\n", name);
        file.text(" }\n");
    }
    file.text("}\n");
    Status status = file.close();
    return status.ok() ? file.pending().commit() : status;
}

/// Gives the whole steps done by a time between steps, where the drawing does not read the time: the session
/// then knows moments of one state by their equal steps.
class WholeSteps {
  public:
    explicit WholeSteps(PictureSession& session) : session_(session) {}

    void give(StageOptions& compile) {
        LowerOptions& lower = compile.lower;
        if (!lower.time || lower.steps) return;
        if (!is_asked_) {
            Compilation compilation;
            const std::shared_ptr<const AnalysedModel> model = session_.analysed(compile, compilation);
            if (!model) return; // the export of the state says why
            is_asked_ = true;
            is_timed_ = !model->derivation || model->derivation->timed;
        }
        if (!is_timed_) lower.steps = static_cast<unsigned>(*lower.time);
    }

  private:
    PictureSession& session_;
    bool is_asked_ = false;
    bool is_timed_ = true; ///< the model, whatever its moving values, once it is asked
};

} // namespace

AnimationOutcome export_animation(PictureSession& session, const AnimateOptions& animate,
                                  const ExportModelOptions& exported) {
    namespace fs = std::filesystem;
    const Stopwatch watch;
    AnimationOutcome outcome;
    const auto fail = [&](Status status) {
        outcome.compilation.status = std::move(status);
        return std::move(outcome);
    };
    const fs::path folder = frames_directory(animate.output);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        return fail(Status::failure(
            fmt::format("cannot make the folder '{}': {}", folder.string(), error.message())));
    std::vector<State> states;
    WholeSteps whole_steps(session);
    std::shared_ptr<const ViewedModel> viewed; // in the state before
    for (std::size_t frame = 0; frame < animate.frames; ++frame) {
        auto [compile, words] = moment_of(animate, static_cast<double>(frame));
        whole_steps.give(compile);
        Compilation compilation;
        // The session gives the same value again where nothing that the model reads has changed.
        if (viewed && session.viewed(compile, compilation) == viewed) {
            ++states.back().end;
            continue;
        }
        compilation = Compilation();
        if (session.control().cancel.raised()) return fail(Status::failure("interrupted"));
        if (animate.on_progress)
            animate.on_progress({AnimationProgress::Stage::drawing, frame, animate.frames, {}, {}});
        const std::string name = fmt::format("frame_{:04}.usda", frame + 1);
        ExportModelOptions state = exported;
        state.compile = compile;
        state.file.output = (folder / name).string();
        const std::optional<std::string> written = export_model(session, state, compilation);
        if (written) viewed = session.viewed(compile, compilation);
        if (!written || !viewed) {
            outcome.frame = fmt::format("frame {} of {} ({})", frame + 1, animate.frames, words);
            outcome.compilation = std::move(compilation);
            return outcome;
        }
        if (animate.on_compiled) animate.on_compiled(compilation);
        // Where it reads what moves, a model may still show the same.
        if (!states.empty() && are_equal(state.file.output, folder.parent_path() / states.back().file)) {
            fs::remove(state.file.output, error);
            ++states.back().end;
            continue;
        }
        states.push_back({frame, frame + 1, (folder.filename() / name).generic_string()});
        ++outcome.drawn;
    }
    const Status status = write_frames(animate, states, viewed->view, exported.file.unit_mm.value_or(1000));
    if (!status.ok()) return fail(status);
    outcome.done = true;
    outcome.seconds = watch.seconds();
    return outcome;
}

} // namespace graftal
