#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/render/gpu_engine.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/povray_engine.h"
#include "runtime/render/render.h"

namespace graftal {

DrawReport& DrawReport::operator+=(const DrawReport& other) {
    summary.clear();
    if (other.error_px) error_px = std::max(error_px.value_or(0), *other.error_px);
    rays += other.rays;
    trace_seconds += other.trace_seconds;
    return *this;
}

std::span<const Engine> engines() {
    static const std::array table = {native_engine, gpu_engine, povray_engine};
    return table;
}

const Engine* find_engine(std::string_view name) {
    if (name == auto_engine) return find_engine(has_gpu() ? gpu_engine.name : native_engine.name);
    for (const Engine& engine : engines())
        if (engine.name == name) return &engine;
    return nullptr;
}

std::string rays_text(const TraceStatistics& rays, double seconds) {
    const double millions = 1e-6 * static_cast<double>(rays.camera_rays) / std::max(seconds, 1e-9);
    std::string text = fmt::format("{:.3g} million rays per second", millions);
    if (rays.given_up > 0)
        text += fmt::format("; graftal gave up {} rays that met too many parts", rays.given_up);
    return text;
}

} // namespace graftal
