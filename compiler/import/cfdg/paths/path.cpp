#include "compiler/import/cfdg/paths/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/import/cfdg/evaluate/affine.h"
#include "compiler/import/cfdg/paths/flags.h"

namespace graftal::cfdg {

namespace {

constexpr int curve_steps = 16;
constexpr double arc_step_deg = 7.5;
constexpr std::size_t most_points = 60'000;
constexpr std::size_t most_path_turns = 20'000; ///< of all loops
constexpr int deepest_paths = 30;               ///< of paths within paths

/// The context of the lines of a path: for operations, the map that moves them; for commands, the change.
struct Under {
    Affine place;
    bool moved = false; ///< the place counts: a loop, a transform or a path of operations alone
    Change change;
};

class Follower {
  public:
    Follower(const Affine& world, const ForeignFile& file, const Grammar& grammar, Evaluator& evaluator)
        : world_(world), file_(file), grammar_(grammar), evaluator_(evaluator) {}

    std::optional<std::vector<PathPart>> run(const Shape& path, const Surroundings& at) {
        walk(path.rules.front().body, at, {});
        if (!drawn_ && good_ && !outlines_.empty()) fill({}, path.span, false);
        if (!good_) return std::nullopt;
        return std::move(parts_);
    }

  private:
    void fail(Span span, std::string message) {
        if (good_) file_.diagnostics.error(span, std::move(message));
        good_ = false;
    }

    double number(const Expr& expression, const Surroundings& at) {
        const std::optional<double> value = evaluator_.number(expression, at);
        good_ = good_ && value;
        return value.value_or(0);
    }

    void walk(const Elements& elements, Surroundings at, const Under& under) {
        for (const Element& element : elements) {
            if (!good_) return;
            switch (element.kind) {
            case Element::Kind::define: {
                std::optional<Value> value = evaluator_.value(element.arguments[0], at);
                good_ = good_ && value;
                if (value) at.values.insert_or_assign(element.name, std::move(*value));
                break;
            }
            case Element::Kind::path_operation:
                operation(element, at, under.moved ? under.place : Affine());
                break;
            case Element::Kind::shape:
                if (element.name == "FILL" || element.name == "STROKE")
                    command(element, at, under);
                else
                    part(element, at, under);
                break;
            case Element::Kind::condition: {
                const bool holds = number(element.arguments[0], at) != 0;
                walk(holds ? element.body : element.other, at, under);
                break;
            }
            case Element::Kind::loop:
                loop(element, at, begin_block(element, at, under));
                break;
            case Element::Kind::transform: {
                const Under inner = begin_block(element, at, under);
                const Draws before = evaluator_.draws;
                for (const Expr& expression : element.arguments) {
                    const std::optional<Value> value = evaluator_.value(expression, at);
                    if (!value || value->kind != Value::Kind::change)
                        return fail(expression.span, "'transform' takes adjustments here");
                    if (element.clones) evaluator_.draws = before;
                    walk(element.body, at, changed(inner, value->change));
                }
                break;
            }
            case Element::Kind::choice:
                if (const Elements* const chosen = evaluator_.choice(element, at))
                    walk(*chosen, at, under);
                else
                    good_ = good_ && file_.diagnostics.error_count() == errors_;
                break;
            }
        }
    }

    static Under changed(Under under, const Change& change) {
        under.place = under.place * change.map;
        under.change.add(change);
        return under;
    }

    /// Operations move with a block that holds nothing else; elsewhere, only commands do.
    Under begin_block(const Element& element, const Surroundings& at, Under under) const {
        const bool alone = operates(element.body, at, 0) && operates(element.other, at, 0);
        if (!alone || under.moved) return under;
        under.place = Affine();
        under.moved = true;
        return under;
    }

    bool operates(const Elements& elements, const Surroundings& at, int depth) const {
        return depth < deepest_paths && std::ranges::all_of(elements, [&](const Element& element) {
                   switch (element.kind) {
                   case Element::Kind::shape: {
                       if (element.name == "FILL" || element.name == "STROKE") return false;
                       const std::optional<std::size_t> path = grammar_.shape(element.name, at.space);
                       return !path || (grammar_.shapes[*path].is_path &&
                                        operates(grammar_.shapes[*path].rules.front().body, at, depth + 1));
                   }
                   case Element::Kind::choice:
                       return std::ranges::all_of(
                           element.cases, [&](const Case& one) { return operates(one.body, at, depth + 1); });
                   case Element::Kind::define:
                   case Element::Kind::path_operation:
                       return true;
                   default:
                       return operates(element.body, at, depth + 1) && operates(element.other, at, depth + 1);
                   }
               });
    }

    void loop(const Element& element, Surroundings at, Under under) {
        const std::optional<LoopBounds> bounds = evaluator_.bounds(element, at);
        if (!bounds) {
            good_ = false;
            return;
        }
        double index = bounds->begin;
        for (; bounds->goes_on(index) && good_; index += bounds->step) {
            if (++turns_ > most_path_turns) return fail(element.span, "the loops of a path turn too often");
            if (!element.name.empty()) at.values.insert_or_assign(element.name, Value::of(index));
            walk(element.body, at, under);
            const std::optional<Change> change = evaluator_.change(element.modification, at);
            good_ = good_ && change;
            if (change) under = changed(std::move(under), *change);
        }
        if (!element.name.empty()) at.values.insert_or_assign(element.name, Value::of(index));
        walk(element.other, at, under);
    }

    /// A path within the path.
    void part(const Element& element, const Surroundings& at, Under under) {
        const std::optional<ShapeValue> named = evaluator_.shape(element, at);
        const std::optional<Change> change =
            named ? evaluator_.change(element.modification, at) : std::nullopt;
        if (!named || !change) {
            good_ = false;
            return;
        }
        const auto found = grammar_.numbers.find(named->name);
        if (found == grammar_.numbers.end()) {
            if (!under.moved) under.place = Affine();
            return primitive(primitive_named(named->name), under.place * change->map, element.span);
        }
        const Shape& path = grammar_.shapes[found->second];
        if (!path.is_path) return fail(element.span, fmt::format("'{}' is no path", named->name));
        if (++depth_ > deepest_paths) return fail(element.span, "paths contain each other too deep");
        std::optional<Values> bound = evaluator_.bind(path.parameters, named->arguments, element.span);
        if (operates(path.rules.front().body, {.space = path.space}, 0)) {
            if (!under.moved) under.place = Affine();
            under.moved = true;
        }
        if (bound)
            walk(path.rules.front().body, {std::move(*bound), path.space, &path},
                 changed(std::move(under), *change));
        good_ = good_ && bound;
        --depth_;
    }

    void primitive(std::string_view kind, const Affine& place, Span span) {
        if (kind.empty()) return fail(span, "this is no path");
        renew();
        std::vector<Point> corners;
        if (kind == "SQUARE") corners = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
        if (kind == "TRIANGLE") corners = triangle;
        if (kind == "CIRCLE")
            for (int i = 0; i < 48; ++i) {
                const double t = i * std::numbers::pi / 24;
                corners.emplace_back(0.5 * std::cos(t), 0.5 * std::sin(t));
            }
        outlines_.emplace_back();
        for (const Point corner : corners)
            add(placed(corner.x, corner.y, place));
        outlines_.back().closed = true;
        at_ = outlines_.back().points.front();
    }

    // Operations

    /// The numbers and flags in the parentheses of version 3.
    std::vector<double> arguments_of(const Element& element, const Surroundings& at, PathFlags& flags) {
        std::vector<double> numbers;
        for (const Expr& argument : element.arguments) {
            const std::optional<Value> value = evaluator_.value(argument, at);
            good_ = good_ && value && flags.add(value->flags, argument.span);
            if (!good_) return numbers;
            numbers.insert(numbers.end(), value->numbers.begin(), value->numbers.end());
        }
        return numbers;
    }

    /// The flags of version 2, which stand among the adjustments, with a note of those that do nothing.
    void add_words(const Element& element, PathFlags& flags) {
        for (const Adjustment& adjustment : element.modification.adjustments) {
            const bool moves = element.kind == Element::Kind::shape && !is_of_paths(adjustment.word);
            if (adjustment.word == "p" && !adjustment.values.empty())
                flags.add_word(adjustment.values[0].text, adjustment.span);
            else if (!moves && !takes_word(element.name, adjustment.word))
                evaluator_.note(adjustment.span,
                                fmt::format("'{}' changes nothing in {}", adjustment.word, element.name));
        }
    }

    /// Coordinates of version 2 stand in braces by name.
    std::vector<double> numbers_of(const Element& element, const Surroundings& at, PathFlags& flags) {
        std::vector<double> numbers = arguments_of(element, at, flags);
        add_words(element, flags);
        if (!element.arguments.empty() || element.name == "CLOSEPOLY") return numbers;
        const auto given = [&](const char* word, double otherwise, bool& there) {
            for (const Adjustment& adjustment : element.modification.adjustments)
                if (adjustment.word == word && !adjustment.values.empty()) {
                    there = true;
                    return number(adjustment.values[0], at);
                }
            return otherwise;
        };
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
            if (!first) flags.add(PathFlag::continuous);
        } else if (element.name.starts_with("ARC")) {
            bool turned = false;
            numbers.insert(numbers.end(), {rx, ry, given("r", 0, turned)});
        }
        return numbers;
    }

    Point placed(double x, double y, const Affine& place) const {
        const Vec3 point = place(Vec3(x, y, 0));
        return {point.x, point.y};
    }

    /// The first operation behind commands begins another path.
    void renew() {
        if (std::exchange(drawn_, false)) outlines_.clear();
    }

    void operation(const Element& element, const Surroundings& at, const Affine& place) {
        renew();
        PathFlags flags(evaluator_, element.name);
        const std::vector<double> n = numbers_of(element, at, flags);
        if (!good_) return;
        const std::string& name = element.name;
        if (!takes_numbers(name, n.size(), flags))
            return fail(element.span, fmt::format("'{}' does not take {} numbers", name, n.size()));
        if (name == "CLOSEPOLY") return close(flags.has(PathFlag::align));
        const bool relative = name.ends_with("REL");
        const Point from = at_;
        const auto point = [&](std::size_t i) {
            const Point offset = placed(n[i], n[i + 1], place);
            return relative ? from + offset : offset;
        };
        const Point to = point(0);
        pulls_ = {1};
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
            // The radii hold under the map: the arc is drawn before it, and moved.
            if (glm::determinant(place.linear) == 0) return add(to);
            const Vec3 start = inverse(place)(Vec3(from, 0));
            const Point end = relative ? Point(start) + Point(n[0], n[1]) : Point(n[0], n[1]);
            arc(n, flags, Point(start), end, place, element);
            if (!relative) at_ = outlines_.back().points.back() = to;
        }
        if (!name.starts_with("CURVE")) control_ = at_;
        if (points_ > most_points) fail(element.span, "the path has too many points");
    }

    /// Aligned, the last point becomes the first of the outline, and what leads to it follows.
    void close(bool aligned) {
        if (outlines_.empty() || outlines_.back().points.empty()) return;
        std::vector<Point>& points = outlines_.back().points;
        outlines_.back().closed = true;
        const Point moved = points.front() - points.back();
        for (std::size_t i = 0; aligned && i < pulls_.size() && i + 1 < points.size(); ++i)
            points[points.size() - 1 - i] += pulls_[pulls_.size() - 1 - i] * moved;
        at_ = points.front();
        control_ = at_;
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
    void curve(const std::vector<double>& n, const PathFlags& flags, const At& point, Point to) {
        const Point from = at_;
        const bool smooth = flags.has(PathFlag::continuous);
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
        pulls_.clear();
        for (int i = 1; i <= curve_steps; ++i) {
            const double t = static_cast<double>(i) / curve_steps, u = 1 - t;
            add(u * u * u * from + 3 * u * u * t * a + 3 * u * t * t * b + t * t * t * to);
            pulls_.push_back(cubic ? t * t * t : t * t);
        }
    }

    /// An arc by end points, as SVG has it (SVG 1.1, appendix F.6.5).
    void arc(const std::vector<double>& n, const PathFlags& flags, Point from, Point to, const Affine& place,
             const Element& element) {
        double rx = n.size() > 2 ? n[2] : 1;
        double ry = n.size() > 4 ? n[3] : rx;
        const double angle = (n.size() > 4 ? n[4] : 0) * std::numbers::pi / 180;
        const bool large = flags.has(PathFlag::arc_large);
        bool clockwise = flags.has(PathFlag::arc_clockwise);
        if (rx < 0) clockwise = !clockwise;
        rx = std::abs(rx);
        ry = std::abs(ry);
        const auto put = [&](Point point) { add(placed(point.x, point.y, place)); };
        if (rx == 0 || ry == 0 || from == to) return put(to);
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
        pulls_.clear();
        // Context Free has a cubic curve for each quarter, of which the last one is pulled.
        const double quarters = std::max(1.0, std::ceil(std::abs(turn) / (std::numbers::pi / 2) - 1e-9));
        const double last = 1 - (quarters - 1) * std::numbers::pi / 2 / std::max(std::abs(turn), 1e-300);
        for (int i = 1; i <= steps; ++i) {
            const double t = first + turn * i / steps;
            const double pulled = std::max(0.0, 1 - (1 - static_cast<double>(i) / steps) / last);
            pulls_.push_back(pulled * pulled * pulled);
            const Point on(rx * std::cos(t), ry * std::sin(t));
            put(i == steps ? to : centre + Point(c * on.x - s * on.y, s * on.x + c * on.y));
        }
    }

    // Commands

    void command(const Element& element, const Surroundings& at, const Under& under) {
        const std::optional<Change> own = evaluator_.change(element.modification, at);
        if (!own) {
            good_ = false;
            return;
        }
        const Change change = changed(under, *own).change;
        PathFlags flags(evaluator_, element.name);
        Stroke stroke;
        const std::vector<double> n = arguments_of(element, at, flags);
        add_words(element, flags);
        if (!good_) return;
        if (!takes_numbers(element.name, n.size(), flags))
            return fail(element.span, fmt::format("'{}' does not take {} numbers", element.name, n.size()));
        if (element.name == "FILL") return fill(change, element.span, flags.has(PathFlag::even_odd));
        if (!n.empty()) stroke.width = n.front();
        for (const Adjustment& adjustment : element.modification.adjustments)
            if (adjustment.word == "width" && !adjustment.values.empty())
                stroke.width = number(adjustment.values[0], at);
        if (!(stroke.width > 0)) return fail(element.span, "a stroke needs a width");
        if (flags.has(PathFlag::round_join)) stroke.join = Join::round;
        if (flags.has(PathFlag::bevel_join)) stroke.join = Join::bevel;
        if (flags.has(PathFlag::round_cap)) stroke.cap = Cap::round;
        if (flags.has(PathFlag::square_cap)) stroke.cap = Cap::square;
        if (!flags.has(PathFlag::iso_width))
            return draw(stroked(outlines_, stroke, evaluator_.outline_work), change, element.span);
        // The pen is round where the path lies: it draws there, in the same area.
        Affine pen = world_ * change.map;
        pen.translation = Vec3(0.0);
        const double size = size_of(pen);
        if (!(size > 0)) return;
        pen.linear[2] = {0, 0, size};
        pen.linear /= size;
        std::vector<Outline> moved = outlines_;
        move(moved, pen);
        std::optional<std::vector<Polygon>> drawn = stroked(moved, stroke, evaluator_.outline_work);
        if (drawn)
            for (Polygon& polygon : *drawn)
                for (Point& point : polygon)
                    point = placed(point.x, point.y, inverse(pen));
        const std::size_t before = parts_.size();
        draw(std::move(drawn), change, element.span);
        if (parts_.size() > before) parts_.back().of_world = true;
    }

    void move(std::vector<Outline>& outlines, const Affine& map) const {
        for (Outline& outline : outlines)
            for (Point& point : outline.points)
                point = placed(point.x, point.y, map);
    }

    void fill(const Change& change, Span span, bool even_odd) {
        draw(filled(outlines_, even_odd, evaluator_.outline_work), change, span);
    }

    void draw(std::optional<std::vector<Polygon>> polygons, const Change& change, Span span) {
        drawn_ = true;
        if (!good_) return;
        if (!polygons) return fail(span, "this path crosses itself too often");
        if (!polygons->empty()) parts_.push_back({std::move(*polygons), change, span});
    }

    const Affine& world_;
    const ForeignFile& file_;
    const Grammar& grammar_;
    Evaluator& evaluator_;
    std::size_t errors_ = file_.diagnostics.error_count();
    std::vector<Outline> outlines_;
    std::vector<PathPart> parts_;
    Point at_{0.0}, control_{0.0};
    std::vector<double> pulls_; ///< how far the last points follow where the last one is moved
    std::size_t points_ = 0, turns_ = 0;
    int depth_ = 0;
    bool drawn_ = false; ///< commands since the last operation
    bool good_ = true;
};

} // namespace

std::optional<std::vector<PathPart>> follow(const Shape& path, const Surroundings& at, const Affine& world,
                                            const ForeignFile& file, const Grammar& grammar,
                                            Evaluator& evaluator) {
    return Follower(world, file, grammar, evaluator).run(path, at);
}

} // namespace graftal::cfdg
