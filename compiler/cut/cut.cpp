#include "compiler/cut/cut.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/cut/assemble.h"
#include "compiler/cut/choose.h"
#include "compiler/cut/cut_graph.h"
#include "compiler/cut/symmetry.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// The error grows by this where the memory does not suffice: a quarter less on each side of a leaf.
constexpr double coarser = 1.25;
/// The nearest that the eye is taken to be, in radii of the model.
constexpr double nearest_share = 1e-5;

std::string readable_count(double count) {
    if (!std::isfinite(count)) return "more than 1e308";
    return count < 1e15 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

std::string readable_bytes(double bytes) {
    const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
    int unit = 0;
    for (; bytes >= 1024 && unit < 5; ++unit)
        bytes /= 1024;
    return fmt::format("{:.3g} {}", bytes, units[unit]);
}

class Cutter {
  public:
    Cutter(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
           const View& view, const CutOptions& options, Diagnostics& diagnostics)
        : graph_(graph), unending_(components.unending[graph.root]), view_(view), options_(options),
          diagnostics_(diagnostics), cut_(prepared(graph, components, bounds, options.root_levels)),
          symmetry_(find_symmetry(cut_)) {}

    std::optional<Cut> run() {
        const bool culls = options_.error_world ? *options_.error_world > 0 : options_.error_px > 0;
        if (unending_ && !options_.steps && !culls) return refuse_endless();
        // A coarser error than the whole picture cannot be asked for.
        const double coarsest = 4.0 * std::max(view_.size.width, view_.size.height);
        CutOptions options = options_;
        double factor = 1;
        for (; options_.error_px * factor <= coarsest || options.error_world; factor *= coarser) {
            if (options.error_world) options.error_world = *options_.error_world * factor;
            bool too_much = false;
            std::optional<Cut> cut = attempt(options, options_.error_px * factor, too_much);
            if (cut) return finish(std::move(*cut), factor, options);
            if (!culls) return refuse_size();
            if (factor > 1e12) break;
        }
        return refuse_size();
    }

  private:
    static CutGraph prepared(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds,
                             const std::vector<unsigned>& root_levels) {
        CutGraph cut = build_cut_graph(graph, components, bounds);
        if (!root_levels.empty()) use_up_levels(cut, root_levels);
        split_into_halves(cut);
        return cut;
    }

    /// The root counts as a level itself, so that it is never the one that is cut.
    static void use_up_levels(CutGraph& cut, const std::vector<unsigned>& root_levels) {
        CutNode root = cut.nodes[cut.root];
        GRAFTAL_CHECK(root.edges.size() == root_levels.size(), "cut: root levels and instances differ");
        for (std::size_t i = 0; i < root_levels.size(); ++i)
            if (root.edges[i].levels > 0) root.edges[i].levels = root_levels[i] + 1;
        cut.root = static_cast<NodeId>(cut.nodes.size());
        cut.nodes.push_back(std::move(root));
    }

    /// Levels of the root.
    std::uint32_t root_steps(const CutOptions& options) const {
        if (!options.steps) return unlimited_steps;
        return *options.steps + (options.root_levels.empty() ? 0 : 1);
    }

    std::optional<Cut> attempt(const CutOptions& options, double error_px, bool& too_much) {
        const double near = nearest_share * std::max(cut_.nodes[cut_.root].ball.radius, 1e-280);
        const Projection projection(view_, options, error_px, near);
        Piece root;
        root.node = cut_.root;
        root.steps = root_steps(options);
        Weights weights(cut_, visible_cube_triangles(cut_, symmetry_, root.steps));
        const auto memory = static_cast<double>(options.memory_bytes);
        const PieceKind whole{root.node, root.steps, PieceKind::step_of(detail_of(cut_, projection, root))};
        choice_ = options.flatten || better_flat(weights.of(whole), memory)
                      ? flat_choice(weights.of(whole))
                      : choose_cut(cut_, symmetry_, projection, root, weights);
        too_much = !(choice_.bytes <= memory);
        if (too_much) return std::nullopt;
        const AssemblyLimits limits{static_cast<std::size_t>(memory / PovrayCosts::placement) + 1,
                                    static_cast<std::size_t>(memory / PovrayCosts::triangle) + 1};
        std::optional<Cut> cut = assemble(cut_, symmetry_, projection, root, choice_, weights, limits);
        too_much = !cut || static_cast<double>(cut->estimated_bytes) > memory;
        if (cut && too_much) choice_.bytes = static_cast<double>(cut->estimated_bytes);
        if (too_much) return std::nullopt;
        return cut;
    }

    static Choice flat_choice(const Weights::Weight& whole) {
        Choice choice;
        choice.leaves = whole.leaves;
        choice.placements = whole.leaves;
        choice.bytes = PovrayCosts::base + whole.leaves * PovrayCosts::placement;
        return choice;
    }

    /// Twigs, leaves and balls are best spelt out where they are few enough: they are drawn exactly, and
    /// POV-Ray traces them several times as fast as their meshes in boxes that overlap.
    static bool better_flat(const Weights::Weight& whole, double memory) {
        constexpr double share_of_memory = 0.25, share_of_leaves = 0.125;
        return flat_choice(whole).bytes <= share_of_memory * memory &&
               whole.curved_leaves > share_of_leaves * whole.leaves;
    }

    Cut finish(Cut cut, double factor, const CutOptions& options) {
        const double unit_px =
            options.error_world ? *options.error_world * root_pixels_per_unit() : options_.error_px * factor;
        cut.error_px *= unit_px;
        cut.error_asked_px =
            options.error_world ? *options_.error_world * root_pixels_per_unit() : options_.error_px;
        if (factor > 1)
            diagnostics_
                .warning(graph_.objects[graph_.root].span,
                         fmt::format("{} of memory allow an error of {:.2f} px, not {:.2f} px",
                                     readable_bytes(static_cast<double>(options_.memory_bytes)), unit_px,
                                     cut.error_asked_px))
                .with_hint("give more with --memory, or ask for less with --error or --steps");
        return cut;
    }

    double root_pixels_per_unit() const {
        const Ball& ball = cut_.nodes[cut_.root].ball;
        return Projection(view_, options_, 1, 1e-5 * std::max(ball.radius, 1e-280)).pixels_per_unit(ball);
    }

    std::nullopt_t refuse_endless() {
        diagnostics_
            .error(graph_.objects[graph_.root].span,
                   "the recursion has no end, and nothing says how deep to draw it")
            .with_hint("give a depth with --steps N, or a size in pixels with --error");
        return std::nullopt;
    }

    std::nullopt_t refuse_size() {
        const auto memory = static_cast<double>(options_.memory_bytes);
        // Where the estimate fitted but what was unfolded did not, nobody knows how much it would have been.
        std::string need;
        if (std::isfinite(choice_.bytes) && choice_.bytes > memory)
            need = "about " + readable_bytes(choice_.bytes) + " in POV-Ray, ";
        diagnostics_
            .error(graph_.objects[graph_.root].span,
                   fmt::format("{} leaves need {}more than the {} allowed", readable_count(choice_.leaves),
                               need, readable_bytes(memory)))
            .with_hint(
                options_.flatten
                    ? "leave out --flatten, cull with --error, lower --steps, or allow more with --memory"
                    : "cull with --error, lower --steps, or allow more with --memory");
        return std::nullopt;
    }

    const Graph& graph_;
    bool unending_;
    const View& view_;
    const CutOptions& options_;
    Diagnostics& diagnostics_;
    CutGraph cut_;
    Symmetry symmetry_;
    Choice choice_;
};

} // namespace

std::optional<Cut> cut_graph(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds, const View& view,
                             const CutOptions& options, Diagnostics& diagnostics) {
    return Cutter(graph, components, bounds, view, options, diagnostics).run();
}

} // namespace graftal
