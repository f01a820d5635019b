// Straight lines of an SVG: line, polyline, polygon, path and use, in groups with transforms.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "compiler/support/number.h"
#include "runtime/inverse/lsystem/drawing_file.h"
#include "runtime/inverse/plane_map.h"

namespace graftal {

namespace {

constexpr std::size_t most_svg_strokes = 1'000'000;
constexpr std::size_t most_svg_elements = 5'000'000; ///< elements that are used count each time
constexpr int most_svg_depth = 100;

PlaneMap composed(const PlaneMap& outer, const PlaneMap& inner) {
    const Vec2 origin = outer({inner.e, inner.f});
    return {outer.a * inner.a + outer.b * inner.c,
            outer.a * inner.b + outer.b * inner.d,
            outer.c * inner.a + outer.d * inner.c,
            outer.c * inner.b + outer.d * inner.d,
            origin.x,
            origin.y};
}

/// Reads numbers and words of attributes one after another.
class SvgScanner {
  public:
    explicit SvgScanner(std::string_view text) : text_(text) {}

    bool at_end() {
        while (!text_.empty() && (std::isspace(static_cast<unsigned char>(text_[0])) || text_[0] == ','))
            text_.remove_prefix(1);
        return text_.empty();
    }
    /// The letter that is next; 0 if none is.
    char letter() {
        if (at_end() || !std::isalpha(static_cast<unsigned char>(text_[0]))) return 0;
        const char letter = text_[0];
        text_.remove_prefix(1);
        return letter;
    }
    std::optional<double> number() {
        if (at_end()) return std::nullopt;
        const std::size_t plus = text_[0] == '+' ? 1 : 0;
        double value = 0;
        const auto [end, error] = read_double(text_.data() + plus, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
        text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
        return value;
    }
    /// The text up to a character, which is passed over.
    std::string_view until(char character) {
        const std::string_view before = text_.substr(0, text_.find(character));
        text_.remove_prefix(std::min(before.size() + 1, text_.size()));
        return before;
    }

  private:
    std::string_view text_;
};

std::optional<PlaneMap> svg_transform(std::string_view text) {
    PlaneMap map;
    SvgScanner scanner(text);
    while (!scanner.at_end()) {
        std::string name(scanner.until('('));
        std::erase_if(name, [](unsigned char c) { return std::isspace(c) || c == ','; });
        SvgScanner inner(scanner.until(')'));
        std::vector<double> v;
        while (const std::optional<double> number = inner.number())
            v.push_back(*number);
        if (!inner.at_end() || v.empty()) return std::nullopt;
        const double radians = v[0] * std::numbers::pi / 180;
        if (name == "matrix" && v.size() == 6) {
            map = composed(map, {v[0], v[2], v[1], v[3], v[4], v[5]});
        } else if (name == "translate" && v.size() <= 2) {
            map = composed(map, {1, 0, 0, 1, v[0], v.size() > 1 ? v[1] : 0});
        } else if (name == "scale" && v.size() <= 2) {
            map = composed(map, {v[0], 0, 0, v.size() > 1 ? v[1] : v[0], 0, 0});
        } else if (name == "rotate" && (v.size() == 1 || v.size() == 3)) {
            const double c = std::cos(radians), s = std::sin(radians);
            const Vec2 centre = v.size() == 3 ? Vec2(v[1], v[2]) : Vec2(0.0);
            map = composed(map, {1, 0, 0, 1, centre.x, centre.y});
            map = composed(map, {c, -s, s, c, 0, 0});
            map = composed(map, {1, 0, 0, 1, -centre.x, -centre.y});
        } else if (name == "skewX" && v.size() == 1) {
            map = composed(map, {1, std::tan(radians), 0, 1, 0, 0});
        } else if (name == "skewY" && v.size() == 1) {
            map = composed(map, {1, 0, std::tan(radians), 1, 0, 0});
        } else {
            return std::nullopt;
        }
    }
    return map;
}

class SvgDrawing {
  public:
    std::optional<Strokes> read(const std::string& text, std::string& problem) {
        pugi::xml_document document;
        const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
        if (!result) {
            problem = fmt::format("its XML is broken at byte {}: {}", result.offset, result.description());
            return std::nullopt;
        }
        const pugi::xml_node root = document.child("svg");
        if (!root) {
            problem = "it has no element 'svg'";
            return std::nullopt;
        }
        if (!gather_names(root) || !visit(root, {1, 0, 0, -1, 0, 0}, 0)) {
            problem = problem_;
            return std::nullopt;
        }
        return std::move(strokes_);
    }

  private:
    bool fail(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }

    /// Without recursion: a broken file may hold any depth.
    bool gather_names(const pugi::xml_node& root) {
        struct Names : pugi::xml_tree_walker {
            std::unordered_map<std::string, pugi::xml_node> found;
            bool for_each(pugi::xml_node& node) override {
                if (const pugi::xml_attribute id = node.attribute("id")) found.emplace(id.value(), node);
                return true;
            }
        } names;
        pugi::xml_node start = root;
        start.traverse(names);
        names_ = std::move(names.found);
        return true;
    }

    bool visit(const pugi::xml_node& node, PlaneMap map, int depth) {
        if (depth > most_svg_depth) return fail("its elements lie too deep in each other");
        if (++elements_ > most_svg_elements)
            return fail(fmt::format("it has more than {} elements", most_svg_elements));
        if (const pugi::xml_attribute transform = node.attribute("transform")) {
            const std::optional<PlaneMap> inner = svg_transform(transform.value());
            if (!inner) return fail(fmt::format("its transform '{:.60}' is broken", transform.value()));
            map = composed(map, *inner);
        }
        const std::string_view name = node.name();
        if (name == "svg" || name == "g" || name == "a" || (name == "symbol" && used_)) {
            return std::ranges::all_of(node.children(), [&](const pugi::xml_node& child) {
                return child.type() != pugi::node_element || visit(child, map, depth + 1);
            });
        }
        if (name == "use") return visit_used(node, map, depth);
        if (name == "line")
            return add(map({number(node, "x1"), number(node, "y1")}),
                       map({number(node, "x2"), number(node, "y2")}));
        if (name == "polyline" || name == "polygon") return add_points(node, map, name == "polygon");
        if (name == "path") return add_path(node.attribute("d").value(), map);
        return true;
    }

    bool visit_used(const pugi::xml_node& node, const PlaneMap& map, int depth) {
        std::string_view target = node.attribute("href").value();
        if (target.empty()) target = node.attribute("xlink:href").value();
        if (!target.starts_with('#')) return fail("a 'use' names no element of the file");
        const auto found = names_.find(std::string(target.substr(1)));
        if (found == names_.end()) return fail(fmt::format("it uses '{:.60}', which is not there", target));
        const bool before = std::exchange(used_, true);
        const bool done = visit(found->second,
                                composed(map, {1, 0, 0, 1, number(node, "x"), number(node, "y")}), depth + 1);
        used_ = before;
        return done;
    }

    static double number(const pugi::xml_node& node, const char* name) {
        return SvgScanner(node.attribute(name).value()).number().value_or(0);
    }

    bool add(Vec2 from, Vec2 to) {
        if (strokes_.size() == most_svg_strokes)
            return fail(fmt::format("it has more than {} lines", most_svg_strokes));
        strokes_.push_back({from, to});
        return true;
    }

    bool add_points(const pugi::xml_node& node, const PlaneMap& map, bool closes) {
        SvgScanner scanner(node.attribute("points").value());
        std::vector<Vec2> points;
        while (const std::optional<double> x = scanner.number()) {
            const std::optional<double> y = scanner.number();
            if (!y) return fail("a list of points has an odd number of numbers");
            points.push_back(map({*x, *y}));
        }
        if (!scanner.at_end()) return fail("a list of points is broken");
        if (closes && points.size() > 2) points.push_back(points.front());
        for (std::size_t i = 1; i < points.size(); ++i)
            if (!add(points[i - 1], points[i])) return false;
        return true;
    }

    bool add_path(std::string_view text, const PlaneMap& map) {
        SvgScanner scanner(text);
        Vec2 at(0.0), first(0.0);
        char command = 0;
        while (!scanner.at_end()) {
            const char letter = scanner.letter();
            if (letter) command = letter;
            const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
            const bool relative = kind != command;
            if (kind == 'Z' && letter) {
                if (at != first && !add(map(at), map(first))) return false;
                at = first;
                continue;
            }
            if (command == 0 || std::string_view("MLHV").find(kind) == std::string_view::npos)
                return fail(command ? fmt::format("its path command '{}' is no straight line", command)
                                    : "a path begins without a command");
            Vec2 next = at;
            const std::optional<double> one = scanner.number(),
                                        two = kind == 'M' || kind == 'L' ? scanner.number() : 0.0;
            if (!one || !two) return fail("a path is broken: a number is missing");
            if (kind == 'V')
                next.y = *one + (relative ? at.y : 0);
            else
                next.x = *one + (relative ? at.x : 0);
            if (kind == 'M' || kind == 'L') next.y = *two + (relative ? at.y : 0);
            if (kind == 'M') {
                first = next;
                command = relative ? 'l' : 'L'; // further points are lines
            } else if (!add(map(at), map(next))) {
                return false;
            }
            at = next;
        }
        return true;
    }

    Strokes strokes_;
    std::unordered_map<std::string, pugi::xml_node> names_;
    std::size_t elements_ = 0;
    bool used_ = false;
    std::string problem_;
};

} // namespace

std::optional<Strokes> svg_strokes(const std::string& text, std::string& problem) {
    return SvgDrawing().read(text, problem);
}

} // namespace graftal
