#include "runtime/points/shares.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/chaos/chances.h"
#include "compiler/detail/projection.h"
#include "compiler/graph/walk.h"
#include "compiler/support/bounds.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_looks = 100'000;
/// A part is looked at as a whole that is as small as this, seen from the eye: its radius over its distance.
constexpr double small_enough = 0.1;
/// A share of the points that is next to nothing.
constexpr double least_share = 1e-3;

class Shown {
  public:
    Shown(const AnalysedModel& model, const View& view)
        : model_(model), graph_(model.graph), sizes_(sizes_of(graph_, model.components, model.bounds)),
          view_(view), projection_(view, {}, 0.5, 1e-9) {}

    /// Sizes of the root's instances. Looks at the largest parts first, so that those taken as wholes at the
    /// end are small.
    std::vector<double> sizes() {
        const std::vector<Instance>& roots = graph_.objects[graph_.root].instances;
        shown_.assign(roots.size(), 0);
        for (std::size_t i = 0; i < roots.size(); ++i)
            look_at(i, roots[i].master, roots[i].parent_from_child);
        for (Part part; walk_.next(part);) {
            if (looks_ > most_looks)
                shown_[part.root] += shown(part);
            else
                for (const Instance& instance : graph_.objects[part.object].instances)
                    look_at(part.root, instance.master, part.map * instance.parent_from_child);
        }
        return std::move(shown_);
    }

  private:
    struct Part {
        std::size_t root = 0; ///< the instance that it belongs to
        ObjectId object = 0;
        Affine map;
        Ball ball;
        double looks = 0; ///< how large, seen from the eye
        bool operator<(const Part& other) const { return looks < other.looks; }
    };

    /// Adds the share of the part as a whole, or leaves its own parts still to be looked at.
    void look_at(std::size_t root, ObjectId object, const Affine& map) {
        ++looks_;
        Part part{root, object, map, transformed(map, model_.bounds[object].ball), 0};
        if (part.ball.empty() || !projection_.sees(part.ball)) return; // planes get no points
        part.looks = look(part.ball);
        const Object& what = graph_.objects[object];
        if (what.primitive || what.packed || model_.components.unending[object] ||
            part.looks <= small_enough || looks_ > most_looks)
            shown_[root] += shown(part);
        else
            walk_.push(part);
    }

    double distance(const Ball& ball) const {
        return std::max(glm::distance(ball.centre, view_.camera.location), ball.radius);
    }
    double look(const Ball& ball) const {
        return view_.camera.orthographic ? ball.radius / view_.camera.width : ball.radius / distance(ball);
    }
    double shown(const Part& part) const {
        const double away = view_.camera.orthographic ? 1 : distance(part.ball);
        return placed_size(graph_, part.object, part.map, sizes_) / (away * away);
    }

    const AnalysedModel& model_;
    const Graph& graph_;
    const std::vector<double> sizes_;
    const View& view_;
    const Projection projection_;
    Walk<Part, std::less<>> walk_;
    std::uint64_t looks_ = 0;
    std::vector<double> shown_; ///< by instances of the root, so far
};

} // namespace

std::vector<double> shown_sizes(const AnalysedModel& model, const View& view) {
    const ObjectId root = model.graph.root;
    const Object& object = model.graph.objects[root];
    const bool stated =
        std::ranges::any_of(object.instances, [](const Instance& instance) { return instance.chance > 0; });
    if (object.instances.size() < 2 || object.packed || stated ||
        model.components.cyclic[model.components.component_of[root]])
        return {};
    std::vector<double> sizes = Shown(model, view).sizes();
    const bool shows = std::ranges::any_of(sizes, [](double size) { return size > 0; });
    return shows ? sizes : std::vector<double>();
}

void warn_of_missed_parts(const AnalysedModel& model, std::vector<double> shares, Diagnostics& diagnostics) {
    const Object& object = model.graph.objects[model.graph.root];
    if (shares.empty()) shares = chances_of(model.graph, model.components, model.bounds)[model.graph.root];
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    std::map<ObjectId, double> of_master;
    for (std::size_t i = 0; i < shares.size(); ++i)
        of_master[object.instances[i].master] += shares[i] / sum;
    for (const Instance& instance : object.instances) {
        double& share = of_master[instance.master];
        if (share > 0 && share < least_share && !model.graph.objects[instance.master].primitive)
            diagnostics
                .warning(instance.span, fmt::format("'{}' gets {:.2g} % of the points",
                                                    model.graph.objects[instance.master].name, 100 * share))
                .with_hint("give it a 'chance', beside those of the other parts, or draw it alone");
        share = 0; // said once
    }
}

} // namespace graftal
