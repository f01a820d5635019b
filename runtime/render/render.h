#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/povray/cut/cut.h"
#include "runtime/fit/fit_picture.h"
#include "runtime/image_files/image_files.h"
#include "runtime/render/picture_session.h"
#include "runtime/trace/picture_film.h"
#include "runtime/trace/sampling.h"
#include "runtime/trace/tile.h"

namespace graftal {

/// Progress of a picture.
struct DrawProgress {
    std::string_view stage;         ///< such as "tracing"
    std::optional<double> fraction; ///< of the stage, in [0, 1], where it is known
    double samples = 0;             ///< a pixel that has been looked at so often; 0: unknown
};

/// An engine's words before it starts on a picture: right within a factor of two or so for many seconds.
struct DrawStart {
    double seconds = 0;       ///< of one processor that it will take
    double whole_seconds = 0; ///< of one processor, for the picture as asked
    std::string fewer;        ///< "4 samples per pixel of 64": what it does without, though nobody
                              ///< asked for less work; or ""
};

/// A picture that is asked for, whatever engine draws it.
struct RenderOptions : PictureWishes {
    StageOptions compile;
    CutOptions cut;                            ///< of POV-Ray
    std::string output;                        ///< where the picture goes: is_picture_name(output)
    PictureFilm* film = nullptr;               ///< of the native engine, in place of the file; null: `output`
    ImageMetadata metadata;                    ///< to be written into it
    SampleFormat format = SampleFormat::srgb8; ///< of a PNG; an EXR is linear anyhow
    std::uint64_t sequence = 0;                ///< TraceControl::sequence
    /// The part to be drawn, in pixels of the picture: with the bits that they have in the whole.
    std::optional<Tile> tile;
    std::optional<PictureFit> fit; ///< of the native engine: known already; requires `progressive` to be off
    int threads = 0;               ///< 0: as many as the engine likes
    /// Numbers of gpu_devices(), for the GPU engine; empty: all cards of the first one's kind.
    std::vector<std::size_t> devices;
    bool aovs = false; ///< of an EXR: further channels (aov_channels.h)
    /// Whether the picture needs what its samples meet, and not only their light.
    bool needs_aovs() const { return aovs || compile.view.transparent; }
    bool progressive = false; ///< write coarse pictures first, each in place of the last
    bool unconfined = false;  ///< PovrayJob::unconfined
    std::string keep;         ///< a directory for the scene, to stay; empty: a temporary one
    std::function<void(const DrawProgress&)> on_progress;
    double seconds_before = 0; ///< that the summary shall count, too: a program's before it draws
    /// Called before the picture starts.
    std::function<void(const DrawStart&)> on_start;

    /// Whether nobody has said how much work a picture may take, or how fine its light is to be.
    bool is_by_default(Quality quality) const {
        return !samples && !noise_255 && !work_seconds && quality != Quality::best;
    }
    void limit_work(double seconds) { compile.detail.work_seconds = work_seconds.emplace(seconds); }
};

/// Results of one picture, or of many.
struct DrawReport {
    std::string summary;            ///< of one picture, for people
    std::optional<double> error_px; ///< the largest, by an engine that bounds it
    TraceStatistics rays;           ///< by an engine that counts them
    double trace_seconds = 0;

    /// Adds up what can be added; there is no summary then.
    DrawReport& operator+=(const DrawReport& other);
};

/// One way from a viewed model to a picture: a row of the table of engines.
struct Engine {
    std::string_view name;    ///< word for `--engine`
    std::string_view summary; ///< for --help
    bool progressive = false; ///< it can write coarse pictures first

    /// Fails, with advice, if the engine is not on this machine.
    Status (*available)();

    /// Says which of the options the engine cannot follow, and what to do; "" if there is none.
    std::string (*refusal)(const RenderOptions& options);

    /// Runs what comes before drawing, in the session, which keeps it. False after errors.
    bool (*compile)(Session& session, const StageOptions& options, Compilation& compilation);

    /// Model -> picture file. Nothing comes back after errors in `compilation.diagnostics` (the model's
    /// fault), or with a failed `compilation.status` (the environment's); then no file appears at the output.
    /// A rendering that is cancelled (Session::control()) cleans up and gives the status "interrupted"; a
    /// progressive one leaves its best picture and reports it.
    std::optional<DrawReport> (*draw)(PictureSession& session, const RenderOptions& options,
                                      Compilation& compilation);
};

/// All engines; the first one draws everywhere.
std::span<const Engine> engines();

/// The engine of a name; null for an unknown one. The automatic one is a GPU's where there is one, else the
/// first: to look for a GPU may take a tenth of a second.
inline constexpr std::string_view auto_engine = "auto";
const Engine* find_engine(std::string_view name);

/// "1.76 million rays per second", and what went wrong with some.
std::string rays_text(const TraceStatistics& rays, double seconds);

} // namespace graftal
