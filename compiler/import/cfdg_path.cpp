#include "compiler/import/cfdg_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/import/cfdg_affine.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

using Point = glm::dvec2;

constexpr int curve_steps = 16;
constexpr double arc_step_deg = 7.5;
constexpr std::size_t most_points = 100'000;
constexpr std::size_t most_corners = 1000; ///< of a polygon
constexpr double usual_stroke = 0.1;

struct Outline {
    std::vector<Point> points;
    bool closed = false;
};

class Follower {
  public:
    Follower(const Shape& path, const ForeignFile& file, const Expressions& expressions)
        : path_(path), file_(file), expressions_(expressions) {}

    std::optional<std::vector<PathPart>> run() {
        walk(path_.rules.front().body, {}, Affine());
        if (parts_.empty() && good_) fill(nullptr, path_.span);
        if (!good_) return std::nullopt;
        return std::move(parts_);
    }

  private:
    void fail(Span span, std::string message) {
        if (good_) file_.diagnostics.error(span, std::move(message));
        good_ = false;
    }

    double number(const Expr& expression, const Numbers& known) {
        const std::optional<double> value = expressions_.number(expression, known);
        if (!value)
            fail(expression.span,
                 "the numbers of a path must be known: parameters and chance are not translated");
        return value.value_or(0);
    }

    void walk(const Elements& elements, Numbers known, Affine place) {
        for (const Element& element : elements) {
            if (!good_) return;
            switch (element.kind) {
            case Element::Kind::define:
                known[element.name] = number(element.arguments[0], known);
                break;
            case Element::Kind::path_operation:
                operation(element, known, place);
                break;
            case Element::Kind::shape:
                command(element, known);
                break;
            case Element::Kind::condition:
                walk(number(element.arguments[0], known) != 0 ? element.body : element.other, known, place);
                break;
            case Element::Kind::loop:
                loop(element, known, place);
                break;
            case Element::Kind::transform: {
                for (const Modification& modification : element.modifications) {
                    const std::optional<Affine> map = affine_of(modification, expressions_, known);
                    if (!map) return fail(modification.span, "the numbers of a path must be known");
                    walk(element.body, known, place * *map);
                }
                break;
            }
            case Element::Kind::choice:
                fail(element.span, "'switch' in a path is not translated");
                break;
            }
        }
    }

    void loop(const Element& element, Numbers known, Affine place) {
        const auto bound = [&](std::size_t i) { return number(element.arguments[i], known); };
        const std::size_t count = element.arguments.size();
        const double begin = count > 1 ? bound(0) : 0, end = bound(count > 1 ? 1 : 0),
                     step = count > 2 ? bound(2) : 1;
        if (!good_) return;
        if (!(step > 0) || !((end - begin) / step <= 10'000))
            return fail(element.span, "a loop in a path has at most 10000 turns, upwards");
        for (double index = begin; index < end - 1e-9 && good_; index += step) {
            if (!element.name.empty()) known[element.name] = index;
            walk(element.body, known, place);
            const std::optional<Affine> map = affine_of(element.modification, expressions_, known);
            if (!map) return fail(element.modification.span, "the numbers of a path must be known");
            place = place * *map;
        }
        walk(element.other, known, place);
    }

    // Operations

    /// Coordinates of version 2 stand in braces by name.
    std::vector<double> numbers_of(const Element& element, const Numbers& known, std::string& flags) {
        std::vector<double> numbers;
        for (const Expr& argument : element.arguments) {
            if (argument.kind == Expr::Kind::name && argument.text.starts_with("CF::"))
                flags += argument.text;
            else if (argument.kind == Expr::Kind::list)
                for (const Expr& part : argument.operands)
                    numbers.push_back(number(part, known));
            else if (argument.kind == Expr::Kind::binary && argument.text == "||")
                flags += flag_text(argument);
            else
                numbers.push_back(number(argument, known));
        }
        if (!element.arguments.empty()) return numbers;
        const auto given = [&](const char* word, double otherwise, bool& there) {
            for (const Adjustment& adjustment : element.modification.adjustments)
                if (adjustment.word == word && !adjustment.values.empty()) {
                    there = true;
                    return number(adjustment.values[0], known);
                }
            return otherwise;
        };
        for (const Adjustment& adjustment : element.modification.adjustments)
            if (adjustment.word == "p" && !adjustment.values.empty()) flags += adjustment.values[0].text;
        bool there = false, first = false, second = false, radii = false, one = false;
        numbers = {given("x", 0, there), given("y", 0, there)};
        const double x1 = given("x1", 0, first), y1 = given("y1", 0, first);
        const double x2 = given("x2", 0, second), y2 = given("y2", 0, second);
        double rx = given("rx", 1, radii), ry = given("ry", 1, one);
        if (radii && !one) ry = rx;
        if (one && !radii) rx = ry;
        if (element.name.starts_with("CURVE")) {
            if (first) numbers.insert(numbers.end(), {x1, y1});
            if (second || !first) numbers.insert(numbers.end(), {x2, y2});
            if (!first) flags += "CF::Continuous";
        } else if (element.name.starts_with("ARC")) {
            bool turned = false;
            numbers.insert(numbers.end(), {rx, ry, given("r", 0, turned)});
        }
        return numbers;
    }

    static std::string flag_text(const Expr& expression) {
        if (expression.kind == Expr::Kind::name) return expression.text;
        std::string text;
        for (const Expr& operand : expression.operands)
            text += flag_text(operand);
        return text;
    }

    Point placed(double x, double y, const Affine& place) const {
        const Vec3 point = place(Vec3(x, y, 0));
        return {point.x, point.y};
    }

    void operation(const Element& element, const Numbers& known, const Affine& place) {
        if (std::exchange(drawn_, false)) outlines_.clear();
        std::string flags;
        const std::vector<double> n = numbers_of(element, known, flags);
        if (!good_) return;
        const std::string& name = element.name;
        if (name == "CLOSEPOLY") {
            if (!outlines_.empty()) outlines_.back().closed = true;
            return;
        }
        if (n.size() < 2) return fail(element.span, fmt::format("'{}' takes coordinates", name));
        const bool relative = name.ends_with("REL");
        const Point from = at_;
        const auto point = [&](std::size_t i) {
            const Point offset = placed(n[i], n[i + 1], place);
            return relative ? from + offset - placed(0, 0, place) : offset;
        };
        const Point to = point(0);
        if (name == "MOVETO" || name == "MOVEREL") {
            outlines_.emplace_back();
            add(to);
        } else if (name == "LINETO" || name == "LINEREL") {
            begin();
            add(to);
        } else if (name.starts_with("CURVE")) {
            begin();
            curve(n, flags, point, to);
        } else {
            begin();
            arc(n, flags, to, element);
        }
        if (name.starts_with("CURVE") == false) control_ = at_;
        if (points_ > most_points) fail(element.span, "the path has too many points");
    }

    void begin() {
        if (outlines_.empty() || outlines_.back().closed) {
            outlines_.emplace_back();
            outlines_.back().points.push_back(at_);
        }
    }

    void add(Point point) {
        outlines_.back().points.push_back(point);
        at_ = point;
        ++points_;
    }

    template<typename At>
    void curve(const std::vector<double>& n, const std::string& flags, const At& point, Point to) {
        const Point from = at_;
        const bool smooth = flags.find("Continuous") != std::string::npos;
        Point a = smooth ? 2.0 * from - control_ : n.size() >= 4 ? point(2) : from;
        const std::size_t last = smooth ? 2 : 4;
        const bool cubic = n.size() >= last + 2;
        Point b = cubic ? point(last) : a;
        if (!cubic) { // a quadratic, as a cubic
            control_ = a;
            const Point middle = a;
            a = from + (middle - from) * (2.0 / 3);
            b = to + (middle - to) * (2.0 / 3);
        } else {
            control_ = b;
        }
        for (int i = 1; i <= curve_steps; ++i) {
            const double t = static_cast<double>(i) / curve_steps, u = 1 - t;
            add(u * u * u * from + 3 * u * u * t * a + 3 * u * t * t * b + t * t * t * to);
        }
    }

    /// By end points, as SVG's (SVG 1.1, appendix F.6.5).
    void arc(const std::vector<double>& n, const std::string& flags, Point to, const Element& element) {
        double rx = n.size() > 2 ? n[2] : 1;
        double ry = n.size() > 4 ? n[3] : rx;
        const double angle = (n.size() > 4 ? n[4] : 0) * std::numbers::pi / 180;
        const bool large =
            flags.find("ArcLarge") != std::string::npos || flags.find("large") != std::string::npos;
        bool clockwise = flags.find("ArcCW") != std::string::npos || flags.find("cw") != std::string::npos;
        if (rx < 0) clockwise = !clockwise;
        rx = std::abs(rx);
        ry = std::abs(ry);
        const Point from = at_;
        if (rx == 0 || ry == 0 || from == to) return add(to);
        const double c = std::cos(angle), s = std::sin(angle);
        const Point half = (from - to) / 2.0;
        const Point p(c * half.x + s * half.y, -s * half.x + c * half.y);
        const double grown = p.x * p.x / (rx * rx) + p.y * p.y / (ry * ry);
        if (grown > 1) rx *= std::sqrt(grown), ry *= std::sqrt(grown);
        const double below = rx * rx * p.y * p.y + ry * ry * p.x * p.x;
        double share = std::sqrt(std::max(0.0, (rx * rx * ry * ry - below) / below));
        const bool sweep = !clockwise; // y points upwards here
        if (large == sweep) share = -share;
        const Point middle(share * rx * p.y / ry, -share * ry * p.x / rx);
        const Point centre =
            Point(c * middle.x - s * middle.y, s * middle.x + c * middle.y) + (from + to) / 2.0;
        const double first = std::atan2((p.y - middle.y) / ry, (p.x - middle.x) / rx);
        double turn = std::atan2((-p.y - middle.y) / ry, (-p.x - middle.x) / rx) - first;
        if (sweep && turn < 0) turn += 2 * std::numbers::pi;
        if (!sweep && turn > 0) turn -= 2 * std::numbers::pi;
        const int steps =
            std::max(1, static_cast<int>(std::ceil(std::abs(turn) * 180 / std::numbers::pi / arc_step_deg)));
        if (!std::isfinite(turn)) return fail(element.span, "this arc has no numbers");
        for (int i = 1; i <= steps; ++i) {
            const double t = first + turn * i / steps;
            const Point on(rx * std::cos(t), ry * std::sin(t));
            add(i == steps ? to : centre + Point(c * on.x - s * on.y, s * on.x + c * on.y));
        }
    }

    // Commands

    void command(const Element& element, const Numbers& known) {
        if (element.name == "FILL") return fill(&element.modification, element.span);
        if (element.name != "STROKE")
            return fail(element.span, fmt::format("'{}' within a path is not translated", element.name));
        double width = usual_stroke;
        for (const Expr& argument : element.arguments)
            if (argument.kind == Expr::Kind::number || expressions_.number(argument, known))
                width = number(argument, known);
        for (const Adjustment& adjustment : element.modification.adjustments)
            if (adjustment.word == "width" && !adjustment.values.empty())
                width = number(adjustment.values[0], known);
        stroke(&element.modification, width, element.span);
    }

    void fill(const Modification* modification, Span span) {
        drawn_ = true;
        PathPart part{{}, modification};
        std::string text;
        std::size_t corners = 0;
        for (const Outline& outline : outlines_) {
            std::vector<Point> points;
            for (const Point point : outline.points)
                if (points.empty() || glm::distance(points.back(), point) > 1e-9) points.push_back(point);
            while (points.size() > 1 && glm::distance(points.front(), points.back()) <= 1e-9)
                points.pop_back();
            if (points.size() < 3) continue;
            points.push_back(points.front());
            corners += points.size();
            for (const Point point : points)
                text += fmt::format("{}{}, {}", text.empty() ? "" : ", ", rounded(point.x), rounded(point.y));
        }
        if (text.empty()) return;
        if (corners > most_corners) return fail(span, "this path has more than 1000 corners");
        part.lines.push_back(fmt::format("instance: polygon({})", text));
        parts_.push_back(std::move(part));
    }

    static std::string rounded(double value) { return shortest(std::round(1e6 * value) / 1e6); }

    void stroke(const Modification* modification, double width, Span span) {
        drawn_ = true;
        PathPart part{{}, modification};
        if (!(width > 0)) return fail(span, "a stroke needs a width");
        for (const Outline& outline : outlines_) {
            std::vector<Point> points = outline.points;
            if (outline.closed && !points.empty()) points.push_back(points.front());
            for (std::size_t i = 0; i + 1 < points.size(); ++i) {
                const Point a = points[i], b = points[i + 1];
                const double length = glm::distance(a, b);
                if (!(length > 1e-9)) continue;
                const double angle = std::atan2(b.y - a.y, b.x - a.x) * 180 / std::numbers::pi;
                const Point middle = (a + b) / 2.0;
                part.lines.push_back(fmt::format(
                    "instance: polygon(-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5)  scale: {}, {}, 1  "
                    "rotate: z, {}  translate: {}, {}, 0",
                    rounded(length), rounded(width), rounded(angle), rounded(middle.x), rounded(middle.y)));
                if (i == 0) continue;
                part.lines.push_back(fmt::format(
                    "instance: cylinder  rotate: x, 90  scale: {0}, {0}, 0.001  translate: {1}, {2}, 0",
                    rounded(width / 2), rounded(a.x), rounded(a.y)));
            }
        }
        if (!part.lines.empty()) parts_.push_back(std::move(part));
    }

    const Shape& path_;
    const ForeignFile& file_;
    const Expressions& expressions_;
    std::vector<Outline> outlines_;
    std::vector<PathPart> parts_;
    Point at_{0.0}, control_{0.0};
    std::size_t points_ = 0;
    bool drawn_ = false; ///< commands since the last operation
    bool good_ = true;
};

} // namespace

std::optional<std::vector<PathPart>> follow(const Shape& path, const ForeignFile& file,
                                            const Expressions& expressions) {
    return Follower(path, file, expressions).run();
}

} // namespace graftal::cfdg
