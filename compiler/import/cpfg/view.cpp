#include "compiler/import/cpfg/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_function_points = 1000;
constexpr int most_function_samples = 100;
constexpr std::size_t most_functions = 200;

struct CurvePoint {
    double x, y;
};

/// A cubic B-spline with open knots: it begins and ends in its first and last points (funcedit).
class FunctionCurve {
  public:
    /// Requires two points or more; fewer than four are joined by straight lines.
    explicit FunctionCurve(const std::vector<CurvePoint>& points)
        : points_(points), order_(std::min<std::size_t>(4, points.size())) {}

    /// The height where the curve is at this place between its ends, found by halving.
    double height_at(double share) const {
        double low = 0, high = pieces();
        const double place = points_.front().x + share * (points_.back().x - points_.front().x);
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (at(middle).x < place ? low : high) = middle;
        }
        return at((low + high) / 2).y;
    }

  private:
    double pieces() const { return static_cast<double>(points_.size() - order_ + 1); }
    double knot(std::size_t j) const {
        return j < order_ ? 0 : std::min(static_cast<double>(j - order_ + 1), pieces());
    }

    /// The point of the curve at `u`, by de Boor's algorithm.
    CurvePoint at(double u) const {
        const auto piece = static_cast<std::size_t>(std::clamp(std::floor(u), 0.0, pieces() - 1));
        std::array<CurvePoint, 4> d{};
        for (std::size_t j = 0; j < order_; ++j)
            d[j] = points_[piece + j];
        for (std::size_t r = 1; r < order_; ++r)
            for (std::size_t j = order_ - 1; j >= r; --j) {
                const double begin = knot(piece + j), end = knot(piece + j + order_ - r);
                const double a = end > begin ? (u - begin) / (end - begin) : 0;
                d[j] = {(1 - a) * d[j - 1].x + a * d[j].x, (1 - a) * d[j - 1].y + a * d[j].y};
            }
        return d[order_ - 1];
    }

    std::vector<CurvePoint> points_;
    std::size_t order_;
};

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

/// The curve that a file of cuspy or funcedit holds (`.con`): a uniform cubic B-spline; nothing for other
/// kinds.
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

class ViewReader {
  public:
    ViewReader(const ForeignFile& file) : file_(file) {}

    CpfgView read(const std::string& name) {
        const std::optional<FileId> view = name.empty() ? std::nullopt : file_.read_beside(name);
        if (view)
            for (const TextLine& line :
                 lines_of(file_.sources.text(*view), 0, file_.sources.text(*view).size()))
                take(line.text.substr(0, std::min(line.text.find("//"), line.text.find("/*"))));
        return std::move(view_);
    }

  private:
    void take(std::string_view line) {
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) return;
        const std::string word(trimmed(line.substr(0, colon)));
        const std::string value(trimmed(line.substr(colon + 1)));
        const double number = leading_number(std::string_view(value).substr(0, 40)).value;
        const bool usable = std::isfinite(number) && std::abs(number) < 1e9;
        if (word == "angle increment" && usable) view_.angle_deg = number;
        if (word == "angle factor" && usable && number != 0) view_.angle_deg = 360 / number;
        if ((word == "initial color" || word == "initial colour") && usable) {
            view_.colour = static_cast<int>(number);
            view_.has_colour = true;
        }
        if ((word == "color increment" || word == "colour increment") && usable)
            view_.colour_increment = static_cast<int>(number);
        if (word == "initial line width" && usable && number > 0) {
            view_.width = number;
            view_.width_in_pixels = value.find(" p") != std::string::npos;
        }
        if (word == "line width increment" && usable) view_.width_increment = number;
        if (word == "line style") {
            if (value.starts_with("cylinder") || value.starts_with("polygon")) view_.width_in_pixels = false;
            if (value.starts_with("pixel") || value.starts_with("wire")) view_.width_in_pixels = true;
        }
        if (word == "surface") {
            std::istringstream words(value);
            char letter = 0;
            CpfgSurface surface;
            if (words >> letter >> surface.file) {
                words >> surface.scale;
                if (!std::isfinite(surface.scale) || surface.scale <= 0) surface.scale = 1;
                view_.surfaces[letter] = surface;
            }
        }
        if (word == "function" || word == "function set") {
            const std::size_t end = std::min(value.find(' '), value.size());
            const int samples = std::atoi(value.substr(end).substr(0, 9).c_str());
            read_functions(value.substr(0, end), samples > 2 ? samples : most_function_samples);
        }
        if (word == "function set") view_.functions_have_names = true;
        if (word == "curve") read_curve(value.substr(0, value.find(' ')));
        if (word == "tropism direction") view_.tropism_direction = three_numbers(value);
        if (word == "initial elasticity" && usable) view_.elasticity = number;
        if (word == "elasticity increment" && usable) view_.elasticity_increment = number;
        if (word == "interpretation past %") view_.draws_past_cuts = value != "off" && value != "no";
        if (word == "tropism" || word == "torque") read_tropism(value, word == "torque");
    }

    static std::string with_blanks(std::string text) {
        std::ranges::replace_if(
            text, [](char c) { return c == ',' || c == ':' || c == '\t'; }, ' ');
        return text;
    }

    static std::string three_numbers(const std::string& text) {
        std::istringstream words(with_blanks(text));
        double x = 0, y = 0, z = 0;
        words >> x >> y >> z;
        return fmt::format("{}, {}, {}", x, y, z);
    }

    /// `T: x y z A: angle I: intensity E: elasticity S: step`
    void read_tropism(const std::string& text, bool twists) {
        std::istringstream words(with_blanks(text));
        CpfgTropism tropism{.direction = "0, 1, 0", .twists = twists};
        std::array<double, 3> direction{0, 1, 0};
        double intensity = 1;
        for (std::string word; words >> word;) {
            double number = 0;
            if (word == "T")
                words >> direction[0] >> direction[1] >> direction[2];
            else if (!(words >> number))
                break;
            if (word == "A") tropism.angle_deg = number;
            if (word == "I") intensity = number;
            if (word == "E") tropism.elasticity = number;
        }
        const double share = std::clamp(intensity, -1.0, 1.0);
        for (double& number : direction)
            number *= (share < 0) != twists ? -1 : 1; // its up is our down
        tropism.elasticity *= std::abs(share);
        tropism.direction = fmt::format("{}, {}, {}", direction[0], direction[1], direction[2]);
        if (view_.tropisms.size() < most_functions) view_.tropisms.push_back(tropism);
    }

    void read_curve(const std::string& name) {
        const std::optional<FileId> file = file_.read_beside(name);
        CpfgViewCurve curve{plain_name(stem_of(name)), {}};
        if (file)
            if (auto known = read_cpfg_curve(file_.sources.text(*file))) curve.curve = std::move(*known);
        if (view_.curves.size() < most_functions) view_.curves.push_back(std::move(curve));
    }

    /// A file of one function, or of a gallery of them. `samples`: of files that do not say how many.
    void read_functions(const std::string& name, int samples) {
        const std::optional<FileId> file = file_.read_beside(name);
        if (!file) return;
        std::istringstream text{std::string(file_.sources.text(*file))};
        CpfgFunction function{std::string(stem_of(name)), {}};
        std::vector<CurvePoint> points;
        std::size_t expected = 0;
        for (std::string line; std::getline(text, line);) {
            std::istringstream words(line);
            std::string word;
            words >> word;
            if (word == "name:") words >> function.name;
            if (word == "samples:") words >> samples;
            if (word == "points:") {
                words >> expected;
                expected = std::min(expected, most_function_points);
                points.clear();
                continue;
            }
            if (points.size() >= expected) continue;
            std::istringstream numbers(line);
            CurvePoint point{};
            int times = 1;
            if (!(numbers >> point.x >> point.y)) continue;
            numbers >> times;
            expected += static_cast<std::size_t>(std::clamp(times, 1, 10)) - 1;
            points.insert(points.end(), static_cast<std::size_t>(std::clamp(times, 1, 10)), point);
            if (points.size() >= expected) add(function, points, samples);
        }
    }

    void add(CpfgFunction function, const std::vector<CurvePoint>& points, int samples) {
        if (points.size() < 2 || view_.functions.size() >= most_functions) return;
        function.name = plain_name(function.name);
        const FunctionCurve curve(points);
        const int pieces = std::clamp(samples, 2, most_function_samples) - 1;
        constexpr double nothing = 1e-12; // of halving
        for (int i = 0; i <= pieces; ++i) {
            const double height = curve.height_at(static_cast<double>(i) / pieces);
            function.values.push_back(std::abs(height) < nothing ? 0 : height);
        }
        view_.functions.push_back(std::move(function));
    }

    const ForeignFile& file_;
    CpfgView view_;
};

} // namespace

CpfgView read_cpfg_view(const ForeignFile& file, const std::string& view_name) {
    return ViewReader(file).read(view_name);
}

} // namespace graftal
