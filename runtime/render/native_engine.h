#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/render/render.h"
#include "runtime/render/stopwatch.h"
#include "runtime/trace/sampling.h"

namespace graftal {

/// graftal's own tracer.
extern const Engine native_engine;

/// Results of a rendering, for the summary.
struct NativeReport {
    TraceStatistics rays;
    double seconds = 0;               ///< of tracing
    double whole_seconds = 0;         ///< from the beginning of the call
    double first_picture_seconds = 0; ///< from the beginning of the call until a picture was there
    bool no_room_to_denoise = false;
    double samples_a_pixel = 0;       ///< of the picture that is there, all over
    bool fewer_where_calm = false;    ///< a pixel has fewer samples where they agree
    double error_px = 0;              ///< of culled parts; 0 where none are
    bool finished = false;            ///< the picture is as it was asked for
    double finer_samples_a_pixel = 0; ///< if an interruption left it: of the part that is finer
    double finer_share = 0;           ///< of its area
    int pictures = 0;                 ///< written
};

/// Engine::draw by the traversal of the graph itself.
std::optional<NativeReport> render_natively(PictureSession& session, const RenderOptions& options,
                                            Compilation& compilation);

/// The beginning of render_natively(), which fits the model to the work and draws nothing. A picture, or a
/// part of it, that is drawn with RenderOptions::fit of this is the very picture that it is without.
std::optional<PictureFit> fit_natively(PictureSession& session, const RenderOptions& options,
                                       Compilation& compilation);

/// Reads the textures of the materials and the ground, or says which cannot be read.
Status load_textures(const std::vector<Material>& materials, const View& view, TextureStore& store,
                     ModelTextures& textures);

/// Runs the stages before a picture. False after errors, or with a failed status.
bool prepare_view(PictureSession& session, const RenderOptions& options, PreparedView& model,
                  Compilation& compilation);

/// A report for people. `device`: that drew it, unless it is the machine's processors.
DrawReport report_of(const NativeReport& report, std::string_view device = "");

/// Traces after the compiler, for render_natively(). `preparing` runs since the preparation began.
std::optional<NativeReport> trace_model(const PreparedView& model, const RenderOptions& options,
                                        const Stopwatch& preparing, const CancelFlag& cancel,
                                        Compilation& compilation);

} // namespace graftal
