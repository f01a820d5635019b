#include "runtime/render/animate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/session/shared_framing.h"
#include "compiler/session/stages.h"
#include "runtime/fit/samplings.h"
#include "runtime/image/develop.h"
#include "runtime/render/frame_clock.h"
#include "runtime/render/frame_store.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"
#include "runtime/render/video.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {

namespace {

using Stage = AnimationProgress::Stage;

/// Number of moments whose mean a frame of moving things is.
int moments_of_exposure(Quality quality) {
    return by_quality(quality, 8, 16, 32);
}

/// Adds up the times of the stages over all frames.
void add_times(const std::vector<StageTime>& times, std::vector<StageTime>& sums) {
    for (const StageTime& time : times) {
        const auto sum = std::find_if(sums.begin(), sums.end(),
                                      [&](const StageTime& other) { return other.stage == time.stage; });
        if (sum == sums.end())
            sums.push_back(time);
        else
            sum->seconds += time.seconds;
    }
}

class Animation {
  public:
    Animation(PictureSession& session, const AnimateOptions& options)
        : session_(session), options_(options), kind_(*animation_kind(options.output)),
          parts_(options.shutter > 0 ? moments_of_exposure(options.render.compile.view.quality) : 1),
          store_(options.frames_folder.empty() ? frames_directory(options.output) : options.frames_folder,
                 options.frames) {}

    AnimationOutcome run() {
        const Stopwatch watch;
        outcome_.done = know_models() && prepare() && draw() && (options_.only || assemble());
        if (!outcome_.done)
            discard();
        else if (!options_.only)
            clean_up();
        outcome_.seconds = watch.seconds();
        return std::move(outcome_);
    }

    AnimationOutcome run_measure(MeasuredAnimation& measured) {
        outcome_.done = measure();
        if (outcome_.done) measured = {framing_, all_sources_.text()};
        return std::move(outcome_);
    }

  private:
    /// The moving values of a frame.
    struct Moment {
        StageOptions compile;
        std::string name; ///< for messages
    };

    /// `part`: of the exposure, from 0.
    Moment moment(std::size_t frame, int part = 0) const {
        const double at = static_cast<double>(frame) + options_.shutter * part / parts_;
        auto [compile, words] = moment_of(options_, at);
        compile.view.turn_deg = turn(at);
        return {std::move(compile), fmt::format("frame {} of {}{}", frame + 1, options_.frames,
                                                words.empty() ? "" : " (" + words + ")")};
    }

    /// Whole turns end where they began, so that the frame after the last would be the first; others end
    /// where they lead to.
    double turn(double at) const {
        const bool closed = std::fmod(options_.turn_deg, 360.0) == 0;
        const auto end = static_cast<double>(std::max<std::size_t>(options_.frames - (closed ? 0 : 1), 1));
        at = std::min(at, end);
        // Multiplied first, so that whole turns come out exactly.
        if (options_.ease == Ease::linear) return options_.turn_deg * at / end;
        return options_.turn_deg * eased(options_.ease, at / end);
    }

    bool know_models() {
        if (!options_.measured) return measure();
        framing_ = options_.measured->framing;
        sources_text_ = options_.measured->sources;
        return true;
    }

    /// Analyses the models of all frames.
    bool measure() {
        auto framing = std::make_shared<SharedFraming>();
        for (std::size_t frame = 0; frame < options_.frames; ++frame) {
            if (cancelled()) return fail("", Status::failure("interrupted"));
            show({Stage::measuring, frame, options_.frames, {}, {}});
            for (int part = 0; part < parts_; ++part)
                if (!measure_model(moment(frame, part), *framing)) return false;
        }
        const ViewOptions view = moment(0).compile.view;
        framing->settle(view.camera, view.size, options_.turn_deg != 0);
        framing_ = std::move(framing);
        sources_text_ = all_sources_.text();
        return true;
    }

    bool measure_model(const Moment& now, SharedFraming& framing) {
        Compilation compilation;
        const std::uint64_t runs = session_.runs().analysed;
        const std::shared_ptr<const AnalysedModel> model = session_.analysed(now.compile, compilation);
        if (!model) return fail(now.name, std::move(compilation));
        add_times(compilation.times, outcome_.compilation.times);
        const std::optional<unsigned> steps = levels_of(*model, now.compile.lower.steps);
        if (sources_.empty() || session_.runs().analysed > runs || steps != steps_) {
            if (options_.on_compiled) options_.on_compiled(compilation);
            framing.include(*model, steps);
            steps_ = steps;
            model_sources_ = Digest().add(compilation.sources);
            all_sources_.add(model_sources_.text());
        }
        sources_.push_back(model_sources_);
        return true;
    }

    /// Checks what would fail late.
    bool prepare() {
        Status status = options_.engine->available();
        if (status.ok() && kind_ == AnimationKind::video) status = video_available();
        if (status.ok() && kind_ != AnimationKind::frames) status = check_writable(options_.output);
        if (status.ok()) status = options_.only ? store_.join() : store_.create();
        if (status.ok()) status = check_writable(store_.path(0));
        return status.ok() || fail("", status);
    }

    /// A frame depends on all models, which are framed together.
    std::string stamp(std::size_t frame) const {
        return Digest()
            .add(options_.identity)
            .add(sources_text_)
            .add(std::to_string(options_.frames))
            .add(std::to_string(frame))
            .text();
    }

    bool draw() {
        std::vector<std::size_t> wanted = options_.only.value_or(std::vector<std::size_t>()), missing;
        if (!options_.only)
            for (std::size_t frame = 0; frame < options_.frames; ++frame)
                wanted.push_back(frame);
        for (const std::size_t frame : wanted)
            if (!store_.has(frame, stamp(frame))) missing.push_back(frame);
        outcome_.found = wanted.size() - missing.size();
        if (!missing.empty() && options_.measured && !options_.only)
            return fail(
                moment(missing.front()).name,
                Status::failure("this frame is not of the job's model: remove it, and submit the job again"));
        const bool sampled =
            !options_.only && !options_.sweeps.empty() && missing.size() >= fewest_sampled_frames;
        if (sampled) put_samples_first(missing);
        FrameClock clock;
        std::vector<double> seconds; // of the first few
        for (std::size_t i = 0; i < missing.size(); ++i) {
            const Stopwatch watch;
            std::optional<double> seconds_left = clock.seconds_left(missing.size() - i);
            if (!draw_frame(missing[i], seconds_left)) return false;
            clock.add(watch.seconds());
            drawn_.push_back(missing[i]);
            ++outcome_.drawn;
            if (seconds.size() == estimating_frames) continue;
            seconds.push_back(watch.seconds());
            if (seconds.size() == estimating_frames && missing.size() > estimating_frames &&
                options_.on_estimate)
                options_.on_estimate(
                    {missing.size(), mean_of(seconds, sampled) * static_cast<double>(missing.size())});
        }
        return true;
    }

    /// A film whose models change makes some of them once more for its samples: a short one is not worth
    /// that.
    static constexpr std::size_t estimating_frames = 3, fewest_sampled_frames = 20;

    /// A film that grows takes longer at its end: its first frame, one in the middle and its last are drawn
    /// before all others.
    static void put_samples_first(std::vector<std::size_t>& frames) {
        const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
        std::rotate(frames.begin() + 1, middle, middle + 1);
        std::rotate(frames.begin() + 2, frames.end() - 1, frames.end());
    }

    /// Mean seconds of a frame: by Simpson's rule where the three are samples in the order above.
    static double mean_of(const std::vector<double>& seconds, bool sampled) {
        const double weight = sampled ? 4 : 1;
        return (seconds[0] + weight * seconds[1] + seconds[2]) / (weight + 2);
    }

    bool draw_frame(std::size_t frame, std::optional<double> seconds_left) {
        if (cancelled()) return fail("", Status::failure("interrupted"));
        show({Stage::drawing, outcome_.found + outcome_.drawn, options_.frames, seconds_left, {}});
        RenderOptions render = options_.render;
        render.output = store_.path(frame);
        render.metadata.stamp = stamp(frame);
        if (parts_ == 1) return draw_moment(frame, 0, seconds_left, render);
        return expose(frame, seconds_left, render);
    }

    /// The mean light of some moments, developed as one picture.
    bool expose(std::size_t frame, std::optional<double> seconds_left, const RenderOptions& picture) {
        TemporaryDirectory folder;
        if (Status status = folder.create(); !status.ok()) return fail("", status);
        RenderOptions render = picture;
        render.output = folder.path() + "/moment.exr";
        render.metadata = {};
        // Moments that differ are samples, too.
        if (render.samples) render.samples = std::max(1, *render.samples / parts_);
        render.noise_255 =
            std::sqrt(parts_) * render.noise_255.value_or(sample_goal(render.compile.view.quality).noise_255);
        std::vector<double> sums;
        Image image;
        for (int part = 0; part < parts_; ++part) {
            if (cancelled()) return fail("", Status::failure("interrupted"));
            if (!draw_moment(frame, part, seconds_left, render)) return false;
            if (Status status = read_image(render.output, image); !status.ok()) return fail("", status);
            sums.resize(image.pixels.size());
            std::transform(sums.begin(), sums.end(), image.pixels.begin(), sums.begin(), std::plus<>());
        }
        std::transform(sums.begin(), sums.end(), image.pixels.begin(),
                       [&](double sum) { return static_cast<float>(sum / parts_); });
        Compilation compilation;
        const auto viewed = session_.viewed(moment(frame).compile, compilation);
        if (!viewed) return fail(moment(frame).name, std::move(compilation));
        Developer(viewed->view.film, picture.format).develop(image, 0, image.height);
        const Status status = write_image(picture.output, image, picture.format, picture.metadata);
        return status.ok() || fail("", status);
    }

    bool draw_moment(std::size_t frame, int part, std::optional<double> seconds_left, RenderOptions render) {
        Moment now = moment(frame, part);
        now.compile.view.framing = framing_;
        render.compile = now.compile;
        render.sequence = static_cast<std::uint64_t>(part); // or all moments would have one noise
        render.on_progress = [&](const DrawProgress& progress) {
            if (progress.fraction)
                show({Stage::drawing, outcome_.found + outcome_.drawn, options_.frames, seconds_left,
                      (part + *progress.fraction) / parts_});
        };
        Compilation compilation;
        const std::size_t picture = frame * static_cast<std::size_t>(parts_) + static_cast<std::size_t>(part);
        if (!draw_picture(picture, render, compilation)) return fail(now.name, std::move(compilation));
        if (options_.on_compiled) options_.on_compiled(compilation); // not before: drawing has warnings, too
        add_times(compilation.times, outcome_.compilation.times);
        return true;
    }

    bool draw_picture(std::size_t picture, const RenderOptions& render, Compilation& compilation) {
        const Engine& engine = *options_.engine;
        if (!engine.compile(session_, render.compile, compilation) || !unchanged(picture, compilation))
            return false;
        const std::optional<DrawReport> report = engine.draw(session_, render, compilation);
        if (report) outcome_.report += *report;
        return report.has_value();
    }

    /// Between the compiler and what draws: the model is still the one that was measured.
    bool unchanged(std::size_t picture, Compilation& compilation) const {
        if (options_.measured || Digest().add(compilation.sources) == sources_[picture]) return true;
        compilation.status = Status::failure("the model changed during the animation; start again");
        return false;
    }

    bool assemble() {
        if (cancelled()) return fail("", Status::failure("interrupted"));
        const OnFrame on_frame = [&](std::size_t frame) {
            show({Stage::assembling, frame, options_.frames, {}, {}});
            return !cancelled();
        };
        Status status;
        if (kind_ == AnimationKind::animated_png)
            status = write_animated_png(options_.output, store_.paths(), options_.rate, on_frame);
        if (kind_ == AnimationKind::gif)
            status = write_gif(options_.output, store_.paths(), options_.rate, on_frame);
        if (kind_ == AnimationKind::video) {
            on_frame(0);
            status = write_video(options_.output, store_, options_.rate, session_.control().cancel,
                                 [&](std::size_t done) { on_frame(std::min(done, options_.frames - 1)); });
        }
        return status.ok() || fail("", status);
    }

    /// Frames that this run has drawn stay for the next one, except where the model is at fault: then there
    /// is no next one of the same frames.
    void discard() {
        if (!outcome_.compilation.diagnostics.has_errors() || options_.only) return;
        for (const std::size_t frame : drawn_)
            store_.remove(frame);
        outcome_.drawn = 0;
    }

    void clean_up() {
        if (kind_ == AnimationKind::frames) outcome_.strangers = store_.strangers();
        if (kind_ == AnimationKind::frames || options_.keep_frames)
            store_.tidy();
        else
            store_.remove();
    }

    bool cancelled() const { return session_.control().cancel.raised(); }

    void show(const AnimationProgress& progress) const {
        if (options_.on_progress) options_.on_progress(progress);
    }

    bool fail(const std::string& frame, Compilation compilation) {
        outcome_.frame = frame;
        outcome_.compilation = std::move(compilation);
        return false;
    }
    bool fail(const std::string& frame, const Status& status) {
        outcome_.compilation.status = status;
        outcome_.frame = frame;
        return false;
    }

    PictureSession& session_;
    const AnimateOptions& options_;
    AnimationKind kind_;
    int parts_; ///< moments of a frame
    FrameStore store_;
    std::shared_ptr<const SharedFraming> framing_;
    std::optional<unsigned> steps_; ///< of the model measured last
    Digest model_sources_;
    Digest all_sources_;
    std::string sources_text_;       ///< the text of all_sources_, once all are known
    std::vector<Digest> sources_;    ///< by frame and moment
    std::vector<std::size_t> drawn_; ///< frames, by this run
    AnimationOutcome outcome_;
};

} // namespace

std::optional<AnimationKind> animation_kind(const std::string& output) {
    const std::filesystem::path path(output);
    if (output.empty()) return std::nullopt;
    if (!path.has_filename() || path.extension().empty()) return AnimationKind::frames;
    static const std::map<std::string, AnimationKind> kinds = {
        {".gif", AnimationKind::gif},   {".png", AnimationKind::animated_png},
        {".mp4", AnimationKind::video}, {".apng", AnimationKind::animated_png},
        {".usda", AnimationKind::usd},  {".webm", AnimationKind::video}};
    const auto kind = kinds.find(path.extension().string());
    return kind == kinds.end() ? std::nullopt : std::optional(kind->second);
}

std::string frames_directory(const std::string& output) {
    std::filesystem::path path(output);
    if (*animation_kind(output) != AnimationKind::frames) return path.replace_extension(".frames").string();
    return path.has_filename() ? output : path.parent_path().string();
}

AnimationMoment moment_of(const AnimateOptions& options, double at) {
    const std::size_t last = std::max<std::size_t>(options.frames - 1, 1);
    const double t = eased(options.ease, std::min(1.0, at / static_cast<double>(last)));
    AnimationMoment moment{options.render.compile, {}};
    for (const Sweep& sweep : options.sweeps) {
        const std::string words = sweep.apply(t, moment.compile);
        moment.words += (moment.words.empty() ? "" : " ") + words;
    }
    return moment;
}

AnimationOutcome animate_model(PictureSession& session, const AnimateOptions& options) {
    return Animation(session, options).run();
}

AnimationOutcome measure_animation(PictureSession& session, const AnimateOptions& options,
                                   MeasuredAnimation& measured) {
    return Animation(session, options).run_measure(measured);
}

} // namespace graftal
