#include "compiler/session/analyse_shapes.h"

#include <optional>

#include "compiler/passes/merge_equivalent.h"
#include "compiler/session/stage_clock.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

void analyse_each(const Graph& graph, const Components& components, AnalysedModel& model, StageClock& clock,
                  const Control& control) {
    model.contraction =
        clock.run("contraction", [&] { return decide_contraction(graph, components, control); });
    if (!converges(model.contraction)) return;
    model.bounds =
        clock.run("bounding", [&] { return bound_objects(graph, components, model.contraction, control); });
}

/// One object for each class, without colours.
Graph folded(const Graph& graph, const ShapeClasses& classes) {
    Graph shapes;
    for (const ObjectId first : classes.first) {
        const Object& source = graph.objects[first];
        Object object;
        object.name = source.name;
        object.primitive = source.primitive;
        object.combination = source.combination;
        object.packed.run = source.packed.run;
        for (const Instance& instance : source.instances)
            object.instances.push_back({classes.class_of[instance.master], instance.parent_from_child});
        shapes.objects.push_back(std::move(object));
    }
    shapes.root = classes.class_of[graph.root];
    return shapes;
}

template<typename T> std::vector<T> spread(const std::vector<T>& by_class, const ShapeClasses& classes) {
    std::vector<T> by_object;
    if (by_class.empty()) return by_object;
    by_object.reserve(classes.class_of.size());
    for (const std::uint32_t own : classes.class_of)
        by_object.push_back(by_class[own]);
    return by_object;
}

} // namespace

bool converges(const Contraction& contraction) {
    return contraction.verdict == Verdict::acyclic || contraction.verdict == Verdict::proved;
}

void analyse_shapes(AnalysedModel& model, std::vector<StageTime>& times, const Control& control) {
    StageClock clock(times);
    const Graph& graph = model.graph;
    if (fewest_pieces(graph, model.components) <= most_pieces)
        return analyse_each(graph, model.components, model, clock, control);
    const ShapeClasses classes = clock.run("shapes", [&] {
        WorkMeter meter(control, "shapes", 1);
        meter.charge(StagePrice::instance_again * static_cast<double>(instance_count(graph)));
        return classes_of_shape(graph);
    });
    if (2 * classes.first.size() > graph.objects.size())
        return analyse_each(graph, model.components, model, clock, control);
    const Graph shapes = folded(graph, classes);
    analyse_each(shapes, strong_components(shapes), model, clock, control);
    model.bounds = spread(model.bounds, classes);
    Contraction& contraction = model.contraction;
    contraction.certificate.metric = spread(contraction.certificate.metric, classes);
    contraction.certificate.log_weight = spread(contraction.certificate.log_weight, classes);
    for (GraphStep& step : contraction.worst_cycle)
        step.object = classes.first[step.object];
}

} // namespace graftal
