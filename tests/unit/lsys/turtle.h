#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/graph/graph.h"
#include "compiler/languages/lower.h"
#include "tests/unit/lsys/words.h"

// A plain turtle over a derived word, by the vectors H, L, U of the book: what all compiled drawings are held
// to.

namespace graftal::testing {

struct Stroke {
    Vec3 from, to;
    double width = 0;
    int colour = 0;
};

struct Figure {
    std::vector<Stroke> strokes;
    std::vector<std::vector<Vec3>> polygons;
    std::size_t modules = 0;
};

class PlainTurtle {
  public:
    PlainTurtle(const LsysGrammar& grammar, const ModuleTable& modules, double width)
        : grammar_(grammar), modules_(modules), now_{.width = width} {}

    Figure draw(const ModuleString& word) {
        figure_.modules = word.size();
        for (const ModuleId module : word)
            step(grammar_.symbols[modules_.symbol(module)], modules_.parameters(module));
        return std::move(figure_);
    }

  private:
    struct State {
        Vec3 position{0.0}, heading{0, 1, 0}, left{-1, 0, 0}, up{0, 0, 1};
        double width = 0;
        int colour = 0;
        double elasticity = 0;
        int tapers = 0;
    };

    static void rotate(Vec3& a, Vec3& b, double angle_deg) { // a towards b
        const double t = angle_deg * std::numbers::pi / 180;
        const Vec3 x = a, y = b;
        a = std::cos(t) * x + std::sin(t) * y;
        b = std::cos(t) * y - std::sin(t) * x;
    }

    void step(const std::string& symbol, std::span<const double> p) {
        const double angle = p.empty() ? grammar_.angle_deg : p[0];
        const double length = p.empty() ? grammar_.step : p[0];
        if (symbol.starts_with("F_")) return forward(length, true); // as the tests' models interpret it
        switch (symbol.size() == 1 ? symbol[0] : '?') {
        case 'F':
            forward(length, true);
            break;
        case 'f':
            forward(length, false);
            break;
        case 'G':
            forward(length, true, false);
            break;
        case 'g':
            forward(length, false, false);
            break;
        case '+':
            rotate(now_.heading, now_.left, angle);
            break;
        case '-':
            rotate(now_.heading, now_.left, -angle);
            break;
        case '&':
            rotate(now_.up, now_.heading, angle);
            break;
        case '^':
            rotate(now_.up, now_.heading, -angle);
            break;
        case '\\':
            rotate(now_.up, now_.left, angle);
            break;
        case '/':
            rotate(now_.up, now_.left, -angle);
            break;
        case '|':
            rotate(now_.heading, now_.left, 180);
            break;
        case '$':
            level();
            break;
        case '!':
            now_.width = p.empty() ? now_.width / std::sqrt(2.0) : p[0];
            break;
        case '\'':
        case ';':
            now_.colour = p.empty() ? now_.colour + 1 : static_cast<int>(p[0]);
            break;
        case ',':
            now_.colour = p.empty() ? now_.colour - 1 : static_cast<int>(p[0]);
            break;
        case 'T':
            now_.elasticity = p.empty() ? 0 : p[0];
            break;
        case '[':
            stack_.push_back(now_);
            if (now_.tapers++ < 12) now_.width *= grammar_.taper.value_or(1);
            break;
        case ']':
            now_ = stack_.back(), stack_.pop_back();
            break;
        case '{':
            polygons_.emplace_back();
            break;
        case '.':
            if (!polygons_.empty()) polygons_.back().push_back(now_.position);
            break;
        case '}':
            figure_.polygons.push_back(polygons_.back()), polygons_.pop_back();
            break;
        default:
            break;
        }
    }

    void forward(double length, bool draw, bool record = true) {
        const Vec3 from = now_.position;
        now_.position += length * now_.heading;
        if (!polygons_.empty() && record) polygons_.back().push_back(now_.position);
        if (polygons_.empty() && draw && length != 0)
            figure_.strokes.push_back({from, now_.position, now_.width, now_.colour});
        if (draw) bend();
    }

    void bend() {
        const Vec3 axis = glm::cross(now_.heading, grammar_.tropism);
        const double sine = glm::length(axis);
        if (now_.elasticity == 0 || sine == 0) return;
        const double t = now_.elasticity * sine;
        const Vec3 k = axis / sine;
        for (Vec3* v : {&now_.heading, &now_.left, &now_.up}) // Rodrigues
            *v = std::cos(t) * *v + std::sin(t) * glm::cross(k, *v) + (1 - std::cos(t)) * glm::dot(k, *v) * k;
    }

    void level() {
        const Vec3 left = glm::cross(Vec3(0, 1, 0), now_.heading);
        if (glm::length(left) < 1e-9) return;
        now_.left = glm::normalize(left);
        now_.up = glm::cross(now_.heading, now_.left);
    }

    const LsysGrammar& grammar_;
    const ModuleTable& modules_;
    State now_;
    std::vector<State> stack_;
    std::vector<std::vector<Vec3>> polygons_;
    Figure figure_;
};

/// These statements, without models, derived and drawn the plain way.
inline Figure plain_figure(const std::string& statements, unsigned steps, double width,
                           std::uint64_t seed = 0) {
    LsysModel model(statements);
    const auto word = model.derive(steps, seed);
    if (!word) throw std::runtime_error(model.errors());
    return PlainTurtle(model.rewriter().grammar(), model.rewriter().modules(), width).draw(*word);
}

/// The bodies of a graph, unfolded in order: cylinders as strokes; the colour is the index of the material.
class Unfolding {
  public:
    explicit Unfolding(const Graph& graph) : graph_(graph) { unfold(graph.root, Affine(), 0); }

    std::vector<Stroke> strokes;
    std::vector<std::array<Vec3, 3>> triangles;
    std::size_t balls = 0;

  private:
    void unfold(ObjectId id, const Affine& place, int material) {
        const Object& object = graph_.objects[id];
        if (object.primitive) return add(*object.primitive, place, material);
        for (const PackedEdge& edge : object.packed)
            add(edge.primitive, place * edge.parent_from_child,
                edge.material ? static_cast<int>(*edge.material) : material);
        for (const Instance& instance : object.instances)
            unfold(instance.master, place * instance.parent_from_child,
                   instance.material ? static_cast<int>(*instance.material) : material);
    }

    void add(const Primitive& kind, const Affine& place, int material) {
        const double half = std::sqrt(3.0) / 2;
        if (kind == PrimitiveKind::cylinder)
            strokes.push_back(
                {place({0, 0, 0}), place({0, 1, 0}), 2 * glm::length(place.linear[0]), material});
        if (kind == PrimitiveKind::triangle)
            triangles.push_back({place({0, 1, 0}), place({-half, -0.5, 0}), place({half, -0.5, 0})});
        if (kind == PrimitiveKind::sphere) ++balls;
    }

    const Graph& graph_;
};

/// These statements compiled to a graph.
struct CompiledLsys {
    CompiledLsys(const std::string& statements, unsigned steps, LowerOptions options = {}) {
        options.steps = steps;
        const std::string text = "lsys m {\n" + statements + "\n}\n";
        LoweredText lowered = lower_text("m.lsys", text, options, sources, diagnostics);
        if (!lowered.graph) throw std::runtime_error(diagnostics.render(sources));
        graph = std::move(*lowered.graph);
        derivation = std::move(lowered.notes.derivation);
    }

    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Derivation> derivation;
    Graph graph;
};

} // namespace graftal::testing
