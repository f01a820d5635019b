#include "compiler/lower/lsys_drawing.h"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/lower/lower_settings.h"
#include "compiler/lower/lsys_composer.h"

namespace graftal {

namespace {

constexpr Vec3 up(0, 1, 0);
// Widths of segments where nothing is said: in steps, but not so thin that a large figure's lines vanish.
constexpr double thinnest_in_steps = 0.1;
constexpr double thickest_in_steps = 0.8;
constexpr double thinnest_in_figure = 1.0 / 400;

struct Paint {
    const char* name;
    Rgb rgb;
};

/// The colours of the indices 0, 1, 2, ... where the model names none.
constexpr std::array<Paint, 8> default_paints = {{
    {"wood", {0.30, 0.17, 0.08}},
    {"leaf", {0.12, 0.33, 0.05}},
    {"shoot", {0.33, 0.50, 0.10}},
    {"yellow", {0.85, 0.62, 0.06}},
    {"red", {0.60, 0.05, 0.04}},
    {"violet", {0.30, 0.12, 0.45}},
    {"white", {0.85, 0.82, 0.78}},
    {"blue", {0.07, 0.18, 0.50}},
}};

// Of figures that use no colours: light, to stand before a dark background.
constexpr Paint curve_paint = {"curve", {0.90, 0.62, 0.22}};
constexpr Paint stalk_paint = {"stalk", {0.50, 0.66, 0.24}};

std::vector<Material> palette_of(std::span<const Paint> paints) {
    std::vector<Material> palette;
    for (const Paint& paint : paints) {
        Material& material = palette.emplace_back();
        material.name = paint.name;
        material.rgb = paint.rgb;
    }
    return palette;
}

bool uses(const LsysGrammar& grammar, std::initializer_list<TurtleCommand> commands) {
    return std::ranges::any_of(grammar.commands, [&](TurtleCommand command) {
        return std::ranges::find(commands, command) != commands.end();
    });
}

class Drawer {
  public:
    Drawer(const LsysGrammar& grammar, const std::map<SymbolId, ObjectId>& models, unsigned steps,
           std::size_t max_parts, Diagnostics& diagnostics)
        : grammar_(grammar), models_(models), steps_(steps), max_parts_(max_parts), diagnostics_(diagnostics),
          rewriter_(grammar, diagnostics) {}

    std::optional<LsysDrawing> draw(Graph& graph, ObjectPool& pool) {
        if (!choose_palette(graph)) return std::nullopt;
        const bool lines = is_line_drawing();
        double width = grammar_.width.value_or(thinnest_in_steps * grammar_.step);
        if (lines) {
            // Composed twice: the first time to see how large the figure is.
            Graph scratch = graph;
            ObjectPool scratch_pool(scratch);
            const std::optional<TurtlePart> sketch = compose(scratch, scratch_pool, width, false);
            if (!sketch) return std::nullopt;
            width = std::clamp(thinnest_in_figure * sketch->reach, width, thickest_in_steps * grammar_.step);
        }
        std::optional<TurtlePart> part = compose(graph, pool, width, lines);
        if (!part) return std::nullopt;
        return LsysDrawing{std::move(part->instances),
                           {"composed", steps_, part->modules.str(), part->segments.str(), part_count_, 0}};
    }

  private:
    bool is_line_drawing() const { return !grammar_.width && !uses(grammar_, {TurtleCommand::width}); }

    /// The materials that the block names, else ours.
    bool choose_palette(const Graph& graph) {
        for (const LsysName& name : grammar_.source->colors) {
            const std::optional<MaterialId> id = material_named(name.text, name.span, graph, diagnostics_);
            if (!id) return false;
            palette_.push_back(graph.materials[*id]);
        }
        if (!palette_.empty()) return true;
        const bool coloured = uses(grammar_, {TurtleCommand::colour_up, TurtleCommand::colour_down,
                                              TurtleCommand::close_polygon});
        const Paint& paint = uses(grammar_, {TurtleCommand::open_branch}) ? stalk_paint : curve_paint;
        palette_ = is_line_drawing() && !coloured ? palette_of({&paint, 1}) : palette_of(default_paints);
        return true;
    }

    std::optional<TurtlePart> compose(Graph& graph, ObjectPool& pool, double width, bool lines) {
        TurtleBodies bodies(graph, palette_);
        TurtleContext turtle{bodies, diagnostics_, grammar_.angle_deg, grammar_.step, lines};
        LsysComposer composer(rewriter_, turtle, pool, models_, max_parts_);
        TurtleState start;
        start.width = width;
        start.tropism = grammar_.tropism;
        start.vertical = up;
        std::optional<TurtlePart> part = composer.compose(steps_, start);
        part_count_ = composer.part_count();
        return part;
    }

    const LsysGrammar& grammar_;
    const std::map<SymbolId, ObjectId>& models_;
    unsigned steps_;
    std::size_t max_parts_;
    Diagnostics& diagnostics_;
    LsysRewriter rewriter_;
    std::vector<Material> palette_; ///< of the colour indices
    std::size_t part_count_ = 0;
};


} // namespace

std::optional<LsysDrawing> draw_lsys(const LsysGrammar& grammar, const std::map<SymbolId, ObjectId>& models,
                                     unsigned steps, std::size_t max_parts, Graph& graph, ObjectPool& pool,
                                     Diagnostics& diagnostics) {
    return Drawer(grammar, models, steps, max_parts, diagnostics).draw(graph, pool);
}

} // namespace graftal
