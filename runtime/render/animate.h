#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/image_files/animation.h"
#include "runtime/render/render.h"
#include "runtime/render/sweep.h"

namespace graftal {

enum class AnimationKind { frames, gif, animated_png, video, usd };

/// The kind that a name ends with: `.gif`; `.png`, `.apng`; `.mp4`, `.webm`; `.usda`, the model itself as it
/// changes (export_animation()); a directory of frames without any or with a slash. Nothing for other names.
std::optional<AnimationKind> animation_kind(const std::string& output);

/// Where the frames are while they are made: the output itself, or NAME.frames beside NAME.gif.
std::string frames_directory(const std::string& output);

struct AnimationProgress {
    enum class Stage { measuring, drawing, assembling };
    Stage stage = Stage::measuring;
    std::size_t frame = 0; ///< from 0; while drawing: how many are there
    std::size_t frames = 0;
    std::optional<double> seconds_left; ///< while drawing, once that can be guessed
    std::optional<double> fraction;     ///< of this frame, once its pixels are being drawn
};

/// Findings of measure_animation(): with them, any frame can be drawn by itself.
struct MeasuredAnimation {
    std::shared_ptr<const SharedFraming> framing;
    std::string sources; ///< a digest of all models that are shown
};

/// An estimate after the first few frames.
struct AnimationEstimate {
    std::size_t frames = 0; ///< to be drawn
    double seconds = 0;     ///< for them, with the first ones, and for putting all together
};

struct AnimateOptions {
    RenderOptions render; ///< of every frame, except moving values, the output and the stamp
    const Engine* engine = &engines().front();
    std::string output; ///< animation_kind(output) is known
    std::size_t frames = 60;
    FrameRate rate;
    double turn_deg = 0; ///< of the camera about the model's vertical axis, over the whole animation
    std::vector<Sweep> sweeps;
    Ease ease = Ease::linear;
    /// Exposure of each frame, as a share of the time between two, in [0, 1]; 0: it shows a moment. Others
    /// are the mean light of 8, 16 or 32 moments, by the quality.
    double shutter = 0;
    bool keep_frames = false;  ///< after they have been assembled
    std::string frames_folder; ///< "": frames_directory(output)
    /// The models are known: they are not looked at before a frame is drawn. Where frames are missing then,
    /// others than `only` are not drawn, and it fails.
    std::optional<MeasuredAnimation> measured;
    /// Numbers of the frames to draw, from 0 on; nothing is put together then. Others may draw in the folder
    /// at the same time. Nothing: all. Requires `measured`.
    std::optional<std::vector<std::size_t>> only;
    std::string identity; ///< the program and its options, on which frames depend besides the model
    std::function<void(const AnimationProgress&)> on_progress;
    /// Once, after the first few frames, if there are more.
    std::function<void(const AnimationEstimate&)> on_estimate;
    /// After each model, and each frame, that is without errors: warnings.
    std::function<void(const Compilation&)> on_compiled;
};

/// The moving values at a time.
struct AnimationMoment {
    StageOptions compile;
    std::string words; ///< of the command line, such as "--steps 4"
};

/// `at`: frames since the first, also between two.
AnimationMoment moment_of(const AnimateOptions& options, double at);

/// The result of an animation.
struct AnimationOutcome {
    bool done = false;
    Compilation compilation; ///< of the fault; if done: the times of all frames together
    std::string frame; ///< if not done: the frame that it went wrong at, e.g. "frame 17 of 60 (--steps 4)"
    std::size_t drawn = 0;     ///< frames
    std::size_t found = 0;     ///< frames that an earlier run had drawn
    std::size_t strangers = 0; ///< frames of other animations in a directory of frames
    DrawReport report;         ///< of all frames drawn
    double seconds = 0;
};

/// Draws the frames that are not there yet and puts them together. All models that are shown are analysed
/// first, and the frames of one model share its analysis and preparation: they are framed together, and a
/// value that a model does not take is found before the first frame is drawn. However it ends, whole frames
/// stay for the next run until the output is there, and the output is whole or not there. Cancelled as
/// for Engine::draw.
AnimationOutcome animate_model(PictureSession& session, const AnimateOptions& options);

/// The beginning of animate_model(), which draws nothing. If it is done, `measured` is filled in.
AnimationOutcome measure_animation(PictureSession& session, const AnimateOptions& options,
                                   MeasuredAnimation& measured);

} // namespace graftal
