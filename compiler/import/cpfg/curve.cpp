#include "compiler/import/cpfg/curve.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr int curve_samples = 400;
constexpr int curve_values = 100;
constexpr std::size_t most_curve_points = 1000;

using CurvePlace = std::array<double, 3>;

/// The place on a piece of four control points, at t of [0, 1].
CurvePlace spline_at(const CurvePlace* points, double t) {
    const double s = 1 - t;
    const std::array<double, 4> weights = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                           (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
    CurvePlace place{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis] += weights[k] * points[k][axis];
    return place;
}

} // namespace

std::optional<CpfgCurve> read_cpfg_curve(std::string_view text) {
    std::vector<CurvePlace> points;
    bool is_spline = false;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text);
        if (words.starts_with("type:")) is_spline = trimmed(words.substr(5)) == "bspline";
        std::istringstream numbers{std::string(words)};
        CurvePlace place{};
        double times = 1;
        if (!(numbers >> place[0] >> place[1] >> place[2])) continue;
        numbers >> times;
        const auto count = static_cast<std::size_t>(std::clamp(times, 1.0, 4.0));
        if (points.size() + count > most_curve_points) return std::nullopt;
        points.insert(points.end(), count, place);
    }
    if (!is_spline || points.size() < 4) return std::nullopt;
    std::vector<CurvePlace> along;
    std::vector<double> lengths = {0};
    const auto pieces = static_cast<double>(points.size() - 3);
    for (int i = 0; i <= curve_samples; ++i) {
        const double u = pieces * i / curve_samples;
        const double piece = std::min(std::floor(u), pieces - 1);
        along.push_back(spline_at(&points[static_cast<std::size_t>(piece)], u - piece));
        if (i == 0) continue;
        const CurvePlace &a = along[along.size() - 2], &b = along.back();
        lengths.push_back(lengths.back() + std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
    }
    CpfgCurve curve;
    curve.length = lengths.back();
    if (!std::isfinite(curve.length) || !(curve.length > 0)) return std::nullopt;
    for (int i = 0; i < curve_values; ++i) {
        const double wanted = curve.length * i / (curve_values - 1);
        const auto after = std::clamp<std::ptrdiff_t>(
            std::ranges::lower_bound(lengths, wanted) - lengths.begin(), 1, curve_samples);
        const auto k = static_cast<std::size_t>(after);
        const double gap = lengths[k] - lengths[k - 1];
        const double share = gap > 0 ? std::clamp((wanted - lengths[k - 1]) / gap, 0.0, 1.0) : 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            curve.points[axis].push_back((1 - share) * along[k - 1][axis] + share * along[k][axis]);
    }
    return curve;
}

} // namespace graftal
