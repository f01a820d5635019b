#include "compiler/detail/coarser.h"

#include <cmath>

#include <fmt/format.h>

namespace graftal {

std::string readable_bytes(double bytes) {
    const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
    int unit = 0;
    for (; bytes >= 999.5 && unit < 5; ++unit)
        bytes /= 1024;
    return fmt::format("{:.3g} {}", bytes, units[unit]);
}

std::string readable_seconds(double seconds) {
    if (!(seconds > 0 && seconds < 1e7)) return fmt::format("{:.2g}", seconds);
    const double unit = std::pow(10, std::floor(std::log10(seconds)) - 1);
    const double enough = std::ceil(seconds / unit - 1e-9) * unit;
    return seconds < 10 ? fmt::format("{:.2g}", enough) : fmt::format("{:.0f}", enough);
}

Limit limit_of_memory(std::uint64_t bytes) {
    return {readable_bytes(static_cast<double>(bytes)) + " of memory", "--memory"};
}

Limit limit_of_work(double seconds) {
    return {fmt::format("{:g} seconds of work", seconds), "--work"};
}

void warn_of_limit(const Span& root, const Limit& limit, const CoarserError& error,
                   Diagnostics& diagnostics) {
    const std::string give = limit.need.empty() ? "give more with " : limit.need + ": give them with ";
    diagnostics
        .warning(root, fmt::format("{} allow an error of {:.2f} px, not {:.2f} px{}", limit.allowed, error.px,
                                   error.asked_px, limit.besides))
        .with_hint(give + limit.option + limit.or_else + ", or ask for less with --error or --steps");
}

void warn_of_shells(const Span& root, const CoarserError& error, Diagnostics& diagnostics) {
    diagnostics
        .warning(root, fmt::format("so many copies overlap that graftal draws their surface with an error of "
                                   "{:.2f} px, not {:.2f} px",
                                   error.px, error.asked_px))
        .with_hint("a larger --work allows more points of the surface; a smaller picture or fewer --steps "
                   "need fewer points");
}

} // namespace graftal
