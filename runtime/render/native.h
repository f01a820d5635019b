#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runtime/render/render.h"
#include "runtime/render/stopwatch.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {

/// How far a picture is.
struct NativeProgress {
    double fraction = 0;        ///< of all rays of the picture as it was asked for
    double samples_a_pixel = 0; ///< of what is in the file, 0 if there is none yet
};

struct NativeOptions {
    RenderOptions render;     ///< of which only what concerns the model, the picture and the threads counts
    bool progressive = false; ///< write coarse pictures first, each in place of the one before
    std::function<void(const NativeProgress&)> on_progress;
};

/// What came of a rendering, for the summary.
struct NativeReport {
    TraceStatistics rays;
    double seconds = 0;               ///< of tracing
    double first_picture_seconds = 0; ///< from the beginning of the call until a picture was there
    double samples_a_pixel = 0;       ///< of the picture that is there, all over
    bool finished = false;            ///< it is as it was asked for
    double finer_samples_a_pixel = 0; ///< if an interruption left it: of the part that is finer
    double finer_share = 0;           ///< of its area
    int pictures = 0;                 ///< written
};

/// Takes a picture in linear light, not clamped, in place of a file.
using PictureSink = std::function<Status(const Image& linear)>;

/// Model -> picture file, by the traversal of the graph itself. As render_model(); but if it is
/// progressive, an interruption leaves the best picture so far, and a report of it with the status
/// "interrupted".
/// With a sink, the pictures go there.
std::optional<NativeReport> render_natively(PictureSession& session, const NativeOptions& options,
                                            Compilation& compilation, const PictureSink& sink = {});

/// What rays go through: the detail is resolved() for the view, and the graph prepared for both.
struct PreparedView {
    std::shared_ptr<const ViewedModel> viewed;
    DetailOptions detail;
    std::shared_ptr<const PreparedCut> prepared;
    ModelTextures textures;
};

/// What follows the compiler in render_natively(). `preparing` runs since the preparation began.
std::optional<NativeReport> trace_model(const PreparedView& model, const NativeOptions& options,
                                        const Stopwatch& preparing, const CancelFlag& cancel,
                                        Compilation& compilation, const PictureSink& sink = {});

} // namespace graftal
