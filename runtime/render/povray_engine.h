#pragma once

#include "runtime/render/render.h"

namespace graftal {

/// POV-Ray, as a child process.
extern const Engine povray_engine;

/// Seconds of one processor that a picture may take unless the options say so: with the usual quality, twenty
/// of two processors.
double povray_seconds(Quality quality);

/// Results of a rendering by POV-Ray.
struct PovrayReport {
    double leaf_count = 0;
    std::uint64_t placement_count = 0;
    std::uint64_t triangle_count = 0;
    double error_px = 0;
    std::uint64_t estimated_bytes = 0;
    std::uint64_t peak_bytes = 0; ///< of POV-Ray
    double povray_seconds = 0;
};

/// Engine::draw by POV-Ray. What the session can give up goes before POV-Ray starts.
std::optional<PovrayReport> render_by_povray(PictureSession& session, const RenderOptions& options,
                                             Compilation& compilation);

/// "8.2e+12 primitives as 514 placements, error 0.4 px"
std::string cut_text(const Cut& cut);

} // namespace graftal
