#pragma once

#include <functional>
#include <optional>
#include <string>

#include "runtime/image/image.h"
#include "runtime/povray/povray.h"
#include "runtime/render/picture_session.h"

namespace graftal {

/// What draws.
enum class Engine { povray, native };

struct RenderOptions {
    StageOptions compile;
    std::string output;                        ///< where the picture goes: is_picture_name(output)
    ImageMetadata metadata;                    ///< to be written into it
    SampleFormat format = SampleFormat::srgb8; ///< of a PNG; an EXR is linear anyhow
    std::optional<int> antialias = 2;          ///< as PovrayJob has it
    int threads = 0;                           ///< 0: as many as POV-Ray likes
    bool unconfined = false;                   ///< PovrayJob::unconfined
    std::string keep;                          ///< a directory for the scene, to stay; empty: a temporary one
    std::function<void(const PovrayProgress&)> on_progress;
    /// Called before POV-Ray starts, with the seconds of one processor that it will take: within a factor of
    /// two or so where they are many, for those are tried on a picture of far fewer pixels.
    std::function<void(double seconds)> on_start;
};

/// What came of a rendering, for the summary.
struct RenderReport {
    double leaf_count = 0;
    std::uint64_t placement_count = 0;
    std::uint64_t triangle_count = 0;
    double error_px = 0;
    double tessellation_px = 0;
    std::uint64_t estimated_bytes = 0;
    std::uint64_t peak_bytes = 0; ///< of POV-Ray
    double povray_seconds = 0;
};

/// Model -> picture file, by POV-Ray. What the session can give up goes before POV-Ray starts. Nothing comes
/// back after errors in `compilation.diagnostics` (the model's fault), or with a failed `compilation.status`
/// (the environment's); then no file appears at the output. A rendering that is cancelled
/// (Session::control()) cleans up and gives the status "interrupted".
std::optional<RenderReport> render_model(PictureSession& session, const RenderOptions& options,
                                         Compilation& compilation);

} // namespace graftal
