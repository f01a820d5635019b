#include "compiler/analysis/contraction.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/analysis/cycle_graph.h"
#include "compiler/analysis/cycle_mean.h"
#include "compiler/analysis/gripenberg.h"
#include "compiler/analysis/metric.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Radii this near to 1 count as 1: products of rotations are not more exact.
constexpr double refuting_radius = 1 - 1e-12;
/// Rates from here on are too near to 1 to be told from it by a re-check in floating point.
constexpr double provable_rate = 1 - 1e-11;

/// Relative room in the rate for the rounding of a re-check that works by other means.
double rounding_room(const ContractionCertificate& certificate) {
    double largest_log = 0;
    for (const double log_weight : certificate.log_weight)
        largest_log = std::max(largest_log, std::abs(log_weight));
    double condition = 1;
    for (const Mat3& l : certificate.metric) {
        if (l == Mat3(1.0)) continue;
        const Vec3 sigma = singular_values(l);
        condition = std::max(condition, sigma.x / sigma.z);
    }
    return 1e-12 + 1e-14 * (largest_log + condition * condition + certificate.depth);
}

/// Knowledge of one component: an interval, the walk behind its lower end, the reasons for its upper end.
struct Findings {
    double lower = 0;
    double upper = 0;
    std::vector<std::uint32_t> walk;
    std::vector<double> log_weight;
    std::vector<Mat3> metric;
    double rate = 0; ///< of the weights and metrics at `depth`
    int depth = 1;
};

/// For all components together; none may take more than half of what is left.
struct EffortLeft {
    std::uint64_t edge_visits = 6'000'000;
    std::uint64_t products = 2'000'000;
};

void take_certificate(Findings& findings, const MetricChoice& choice, double log_rate, int depth) {
    findings.metric = choice.metric;
    findings.log_weight = choice.log_weight;
    findings.rate = std::exp(log_rate);
    findings.depth = depth;
}

/// Step 1: the norms as they are, in the best unit for each object. Exact for similarities.
MetricChoice by_cycle_mean(const CycleGraph& cycle, Findings& findings) {
    std::vector<double> weight;
    bool similarities = true;
    for (const CycleEdge& edge : cycle.edges) {
        const Mat3& linear = cycle.transform(edge).linear;
        weight.push_back(log_norm(linear));
        similarities = similarities && similarity_ratio(linear) > 0;
    }
    CycleMean found = max_cycle_mean(cycle, weight);
    findings.lower =
        std::exp(log_spectral_radius(cycle, found.cycle) / static_cast<double>(found.cycle.size()));
    findings.upper = std::exp(found.bound);
    if (similarities && findings.upper - findings.lower <= 1e-9 * findings.upper)
        findings.upper = findings.lower;
    findings.walk = std::move(found.cycle);
    MetricChoice plain{std::vector<Mat3>(cycle.size(), Mat3(1.0)), std::move(found.potential), found.bound,
                       1};
    take_certificate(findings, plain, plain.log_rate, 1);
    return plain;
}

/// Step 2: other metrics. Gives the choice with the least rate. The certificate becomes the one with the
/// least condition / (1 - rate), where any proves something: by that factor bounds begin too large
/// (bounding.h).
MetricChoice by_metrics(const CycleGraph& cycle, const MetricChoice& plain, Findings& findings,
                        EffortLeft& effort) {
    const auto width = [](const MetricChoice& choice) {
        const double rate = std::exp(choice.log_rate);
        return rate <= provable_rate ? choice.condition / (1 - rate) : INFINITY;
    };
    std::uint64_t visits = effort.edge_visits / 2;
    effort.edge_visits -= visits;
    MetricChoice best = plain;
    double least_width = width(plain);
    for (const MetricChoice& choice : search_metrics(cycle, plain, visits)) {
        if (width(choice) < least_width) {
            least_width = width(choice);
            take_certificate(findings, choice, choice.log_rate, 1);
        }
        if (choice.log_rate < best.log_rate) best = choice;
    }
    effort.edge_visits += visits;
    findings.upper = std::min(findings.upper, std::exp(best.log_rate));
    return best;
}

/// Step 3: paths. With a proof at hand a little effort, to narrow the interval.
void by_paths(const CycleGraph& cycle, const MetricChoice& choice, Findings& findings, EffortLeft& effort) {
    const bool proved = findings.rate <= provable_rate;
    PathSearchLimits limits;
    limits.log_lower = std::log(std::max(findings.lower, 1e-300));
    limits.prove = !proved;
    limits.products = std::min<std::uint64_t>(effort.products / 2, proved ? 20'000 : 1'000'000);
    const PathSearch found = search_paths(cycle, choice, limits);
    effort.products -= std::min(effort.products, found.products);
    if (!found.walk.empty()) {
        findings.lower = std::exp(found.log_lower);
        findings.walk = found.walk;
    }
    findings.upper = std::max(findings.lower, std::min(findings.upper, std::exp(found.log_rate)));
    if (!proved && std::exp(found.log_rate) <= provable_rate)
        take_certificate(findings, choice, found.log_rate, found.depth);
}

Findings examine(const CycleGraph& cycle, EffortLeft& effort) {
    Findings findings;
    const MetricChoice plain = by_cycle_mean(cycle, findings);
    const auto settled = [&findings] {
        return findings.lower >= refuting_radius || findings.upper - findings.lower <= 1e-9 * findings.upper;
    };
    if (settled()) return findings;
    const MetricChoice best = by_metrics(cycle, plain, findings, effort);
    if (!settled()) by_paths(cycle, best, findings, effort);
    return findings;
}

/// The steps of a closed walk, begun at its object of least number.
std::vector<GraphStep> steps_of(const CycleGraph& cycle, const std::vector<std::uint32_t>& walk) {
    std::vector<GraphStep> steps;
    for (const std::uint32_t e : walk)
        steps.push_back(cycle.edges[e].step);
    const auto least =
        std::min_element(steps.begin(), steps.end(),
                         [](const GraphStep& a, const GraphStep& b) { return a.object < b.object; });
    std::rotate(steps.begin(), least, steps.end());
    return steps;
}

void take_in(Contraction& result, const CycleGraph& cycle, const Findings& findings) {
    if (findings.lower > result.lower || result.worst_cycle.empty()) {
        result.lower = findings.lower;
        result.worst_cycle = steps_of(cycle, findings.walk);
    }
    result.upper = std::max(result.upper, findings.upper);
    result.certificate.rate = std::max(result.certificate.rate, findings.rate);
    result.certificate.depth = std::max(result.certificate.depth, findings.depth);
    for (std::uint32_t v = 0; v < cycle.size(); ++v) {
        result.certificate.metric[cycle.objects[v]] = findings.metric[v];
        result.certificate.log_weight[cycle.objects[v]] = findings.log_weight[v];
    }
}

} // namespace

Contraction decide_contraction(const Graph& graph, const Components& components, const Control& control) {
    Contraction result;
    if (!components.any_cycle()) return result;
    result.certificate.metric.assign(graph.objects.size(), Mat3(1.0));
    result.certificate.log_weight.assign(graph.objects.size(), 0.0);
    const std::vector<std::uint32_t> places = places_in_components(components);
    EffortLeft effort;
    WorkMeter meter(control, "contraction", 1, StagePrice::cycle_edge);
    for (std::uint32_t c = 0; c < components.members.size(); ++c) {
        if (!components.cyclic[c]) continue;
        const CycleGraph cycle = cycle_graph(graph, components, places, c);
        meter.add(cycle.edges.size());
        take_in(result, cycle, examine(cycle, effort));
    }
    result.certificate.rate *= 1 + rounding_room(result.certificate);
    if (result.lower >= refuting_radius)
        result.verdict = Verdict::refuted;
    else if (result.certificate.rate <= provable_rate &&
             certificate_holds(graph, components, result.certificate))
        result.verdict = Verdict::proved;
    else
        result.verdict = Verdict::undecided;
    if (result.verdict != Verdict::proved) result.certificate = {};
    if (result.verdict == Verdict::undecided) result.upper = std::max(result.upper, 1.0);
    return result;
}

std::string describe_cycle(const Graph& graph, const std::vector<GraphStep>& cycle) {
    constexpr std::size_t shown_in_full = 12;
    constexpr std::size_t shown_at_each_end = 4;
    std::string text;
    for (std::size_t i = 0; i < cycle.size(); ++i) {
        if (cycle.size() > shown_in_full && i == shown_at_each_end) {
            const std::size_t left_out = cycle.size() - 2 * shown_at_each_end;
            text += fmt::format("... ({} more) -> ", left_out);
            i += left_out;
        }
        text += fmt::format("{} -> ", graph.objects[cycle[i].object].name);
    }
    if (!cycle.empty()) text += graph.objects[cycle.front().object].name;
    return text;
}

} // namespace graftal
