#include "compiler/import/cfdg/scene.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/import/cfdg/paths/outline.h"
#include "compiler/import/cfdg/text.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/own_words.h"
#include "compiler/support/hue.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

/// Neighbours of the tile on each side that reach into it.
constexpr int neighbours = 2;
constexpr std::size_t most_copies = 20'000;

bool moves_in_depth(const Modification& modification) {
    return std::ranges::any_of(modification.adjustments, [](const Adjustment& adjustment) {
        return adjustment.word == "z" || (adjustment.word == "x" && adjustment.values.size() == 3) ||
               (adjustment.word == "y" && adjustment.values.size() == 2);
    });
}

/// Whether any modification in the lines is such.
template<typename Test> bool holds(const Elements& elements, const Test& test) {
    return std::ranges::any_of(elements, [&](const Element& element) {
        return test(element.modification) || holds(element.body, test) || holds(element.other, test) ||
               std::ranges::any_of(element.arguments,
                                   [&](const Expr& value) { return value.change && test(*value.change); }) ||
               std::ranges::any_of(element.cases, [&](const Case& one) { return holds(one.body, test); });
    });
}

} // namespace

SceneWriter::SceneWriter(const ForeignFile& file, const Grammar& grammar)
    : file_(file), grammar_(grammar), evaluator_(file, grammar) {
    for (const char* const taken : {"flat", "scene"})
        names_.insert(taken);
    const auto fades = [](const Modification& modification) {
        return std::ranges::any_of(modification.adjustments, [](const Adjustment& adjustment) {
            if (adjustment.word != "a" && !(adjustment.word == "h" && adjustment.values.size() == 4))
                return false;
            const Expr& alpha = adjustment.values.back(); // what is opaque stays so with none less
            return adjustment.sets_target || adjustment.to_target || alpha.kind != Expr::Kind::number ||
                   alpha.number < 0;
        });
    };
    const auto anywhere = [&](const auto& test) {
        return (grammar_.start && test(grammar_.start->modification)) ||
               std::ranges::any_of(grammar_.shapes,
                                   [&](const Shape& shape) {
                                       return std::ranges::any_of(shape.rules, [&](const Rule& rule) {
                                           return holds(rule.body, test);
                                       });
                                   }) ||
               std::ranges::any_of(grammar_.definitions, [&](const Definition& definition) {
                   return definition.value.change && test(*definition.value.change);
               });
    };
    translucent_ = anywhere(fades);
    deep_ = anywhere(moves_in_depth);
}

/// A polygon of as many corners as a large picture needs.
std::string SceneWriter::disc_text() {
    constexpr int corners = 72;
    Polygon disc;
    for (int i = 0; i < corners; ++i) {
        const double t = 2 * std::numbers::pi * i / corners;
        disc.emplace_back(0.5 * std::cos(t), 0.5 * std::sin(t));
    }
    return polygon_text(disc);
}

void SceneWriter::check_definitions() {
    static const std::set<std::string, std::less<>> harmless = {
        "CF::Impure",      "CF::MinimumSize",  "CF::MaxNatural", "CF::MaxShapes", "CF::BorderDynamic",
        "CF::BorderFixed", "CF::Color",        "CF::ColorDepth", "CF::Time",      "CF::Frame",
        "CF::FrameTime",   "CF::AllowOverlap", "CF::Alpha",      "CF::Looped"};
    if (grammar_.tile)
        if (const std::optional<Change> tile = evaluator_.change(*grammar_.tile, {})) {
            lattice_.across = {tile->map.linear[0].x, tile->map.linear[0].y, 0};
            lattice_.up = {tile->map.linear[1].x, tile->map.linear[1].y, 0};
            if (lattice_.across == Vec3(0.0) && lattice_.up == Vec3(0.0))
                fail(grammar_.tile->span, "this tile has no size");
        }
    for (const Definition& definition : grammar_.definitions) {
        if (!definition.name.starts_with("CF::")) continue;
        if (harmless.contains(definition.name))
            file_.diagnostics.note(definition.span,
                                   fmt::format("'{}' changes nothing here", definition.name));
        else if (definition.name == "CF::Symmetry")
            read_symmetry(definition);
        else
            fail(definition.span, fmt::format("'{}' is not translated", definition.name));
    }
    if (copies_.empty()) copies_.emplace_back();
    if (grammar_.tile) add_tiles();
}

/// `CF::Symmetry = CF::Dihedral, 5, 30, CF::p2, [r 90]`: flags with their numbers, and adjustments.
void SceneWriter::read_symmetry(const Definition& definition) {
    const Expr& value = definition.value;
    const std::vector<Expr> alone = {value};
    SymmetryReader reader(lattice_, copies_, [&](const std::string& fault) { fail(definition.span, fault); });
    for (const Expr& part : value.kind == Expr::Kind::list ? value.operands : alone) {
        const std::optional<Value> one = evaluator_.value(part, {});
        if (!one) return;
        if (one->kind == Value::Kind::flags) {
            reader.begin(one->flags);
        } else if (one->kind == Value::Kind::change && one->change.colours.empty()) {
            reader.end();
            add_unique(copies_, {one->change.map});
        } else if (one->kind != Value::Kind::numbers || !reader.add(one->numbers)) {
            return fail(part.span, "a symmetry is a word, its numbers, or an adjustment that moves");
        }
    }
    reader.end();
}

/// Adds neighbouring tiles: shapes that reach over an edge of the tile come in again on the other side.
void SceneWriter::add_tiles() {
    const std::vector<Affine> one = copies_;
    const int columns = lattice_.across == Vec3(0.0) ? 0 : neighbours,
              rows = lattice_.up == Vec3(0.0) ? 0 : neighbours;
    for (int i = -columns; i <= columns; ++i)
        for (int j = -rows; j <= rows; ++j) {
            if (i == 0 && j == 0) continue;
            for (const Affine& map : one)
                copies_.push_back(Affine::translate(static_cast<double>(i) * lattice_.across +
                                                    static_cast<double>(j) * lattice_.up) *
                                  map);
        }
    if (copies_.size() > most_copies) {
        copies_.clear();
        fail(grammar_.tile->span, "the symmetries of this tile make too many copies");
    }
}

void SceneWriter::write_scene() {
    Rgb screen(1.0);
    if (grammar_.background)
        if (const std::optional<Change> change = evaluator_.change(*grammar_.background, {})) {
            std::array<double, 4> hsv = {0, 0, 1, 1};
            for (const ColourStep& step : change->colours) {
                double& part = hsv[static_cast<std::size_t>(step.channel)];
                if (step.kind != ColourStep::Kind::change)
                    fail(grammar_.background->span, "the background changes by plain numbers only");
                part += step.channel == Channel::hue
                            ? step.amount
                            : std::abs(step.amount) * ((step.amount > 0 ? 1 : 0) - part);
            }
            screen = rgb_from_hsv(hsv[0], hsv[1], hsv[2]);
            if (hsv[3] < 1) file_.diagnostics.note(grammar_.background->span, "the background covers here");
        }
    line("background: " + linear_text({screen.r, screen.g, screen.b}));
    write_camera();
    line("light { sun: 0,0,1  color: 0,0,0 }   # colours are as they are");
    line("material flat { color: 1,1,1  ambient: 1  diffuse: 0  specular: 0 }");
}

void SceneWriter::write_camera() {
    const bool sized = grammar_.size.has_value();
    const std::optional<Modification>& given = sized ? grammar_.size : grammar_.tile;
    const std::optional<Change> change = given ? evaluator_.change(*given, {}) : std::nullopt;
    const Mat3 size = change ? change->map.linear : Mat3(0.0);
    // A tile that leans is as wide as its lower side, and as high as it is.
    const double wide = std::max(std::abs(size[0].x), std::abs(size[0].y) > 0 ? glm::length(size[0]) : 0.0);
    const double high = std::abs(size[1].y);
    const auto view = [&](Vec3 at, double width, double tall, Span span) {
        line(fmt::format("camera {{ orthographic  location: {0},{1},{2}  look_at: {0},{1},0  width: {3}  "
                         "height: {4} }}",
                         shortest(at.x), shortest(at.y), shortest(camera_height_), shortest(width),
                         shortest(tall)),
             span);
    };
    if (wide > 0 && high > 0) // the picture is moved by the offset, not the canvas
        view(-change->map.translation, wide, high, given->span);
    else if (middle_and_half_)
        view(middle_and_half_->first, 2 * middle_and_half_->second.x, 2 * middle_and_half_->second.y, {});
    else // of a frieze, one size follows from what it draws
        line("camera { orthographic  direction: 0,0,-1 }");
}

void SceneWriter::write_start(const std::string& instance, const std::string& inks) {
    line("");
    line("object scene {");
    ++depth_;
    // Context Free paints the copies of a shape one after the other.
    double height = 0;
    const double step = copy_step_ / static_cast<double>(copies_.size());
    for (const Affine& flat : copies_) {
        const Affine copy = Affine::translate({0, 0, height}) * flat;
        height += step;
        line(fmt::format("instance: {}{}  ink: hsv(0, 0, 0){}", instance, moves_text(copy), inks),
             grammar_.start->span);
    }
    --depth_;
    line("}");
}

std::string SceneWriter::primitive(std::string_view kind) {
    auto [known, fresh] = primitives_.try_emplace(std::string(kind));
    if (fresh) known->second = free_name(kind);
    return known->second;
}

void SceneWriter::write_end() {
    for (const auto& [key, name] : primitives_) {
        line("");
        line(fmt::format("canonical object {} {{", name));
        if (key == "CIRCLE" && !translucent_)
            line("    instance: cylinder  rotate: x, 90  scale: 0.5, 0.5, 0.0001  translate: 0, 0, -0.0001  "
                 "material: flat");
        else if (key == "CIRCLE") // of one surface, so that light passes it once
            line(fmt::format("    {}  material: flat", disc_text()));
        else if (key == "SQUARE")
            line("    instance: polygon(-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5)  material: flat");
        else
            line(fmt::format("    {}  material: flat", polygon_text(triangle)));
        line("}");
    }
    for (const std::string& words : grammar_.tail)
        comment(words);
}

std::string SceneWriter::free_name(std::string_view wanted) {
    return free_own_name(wanted, "_shape", names_);
}

void SceneWriter::fail(Span span, std::string message, std::string hint) {
    file_.diagnostics.error(span, std::move(message)).with_hint(std::move(hint));
}

void SceneWriter::fail_without_start() {
    const std::string first = grammar_.shapes.empty() ? "NAME" : grammar_.shapes.front().name;
    fail(file_.span(0, 0), "the grammar has no 'startshape'",
         fmt::format("name the shape to draw in the first line: startshape {}", first));
}

void SceneWriter::comment(const std::string& words) {
    line("# " + comment_text(words));
}

void SceneWriter::line(const std::string& words, Span origin) {
    out_.line(words.empty() ? words : std::string(static_cast<std::size_t>(4 * depth_), ' ') + words,
              origin.file == file_.file ? origin : Span());
}

} // namespace graftal::cfdg
