#pragma once

#include <string>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/support/control.h"

namespace graftal {

/// One step of a path in the graph: instance number `instance` of object `object`.
struct GraphStep {
    ObjectId object = 0;
    std::uint32_t instance = 0;
    bool operator==(const GraphStep&) const = default;
};

enum class Verdict { acyclic, proved, refuted, undecided };

/// A checkable reason why every cycle contracts. Each object of a cycle has a metric |L x| p. Take any path
/// of `depth` instances that stays in one component. It has a prefix of one instance or more, root side
/// first, from v to u. Its linear part M shrinks lengths by `rate` an instance at least:
///     |L_v M L_u^-1|_2 p_u <= rate^length p_v.
/// Depth 1 is the usual case; there identity metrics say that the instances contract as they stand, up to a
/// choice of unit for each object.
struct ContractionCertificate {
    std::vector<Mat3> metric;       ///< L by object, upper triangular; the identity outside cycles
    std::vector<double> log_weight; ///< log p by object; 0 outside cycles
    double rate = 0;                ///< < 1
    int depth = 1;
};

/// Whether the unfolding converges. `lower` and `upper` enclose the joint spectral radius of the component
/// that contracts least (constrained to its paths). It is the factor of a level in the long run.
struct Contraction {
    Verdict verdict = Verdict::acyclic;
    double lower = 0;
    double upper = 0;
    std::vector<GraphStep> worst_cycle; ///< the cycle that gives `lower`, from an object back to itself
    ContractionCertificate certificate; ///< of a PROVED verdict

    /// The figure to print: the spectral radius of the worst cycle, per instance.
    double rate() const { return lower; }
};

/// Decides by the cycle mean of norms, one linear solve for metrics, then Gripenberg's branch and bound over
/// paths (Karp 1978, Gripenberg 1996). Effort is bounded: what it cannot settle it calls undecided, with the
/// interval reached. A refutation names a cycle whose spectral radius is at least 1.
Contraction decide_contraction(const Graph& graph, const Components& components,
                               const Control& control = no_control());

/// Re-checks a certificate from the graph alone, by other means than those that found it: eigenvalues of
/// M^T M with a margin for rounding, over all paths as far as needed. False, too, where that takes over
/// 5 * 10^6 products.
bool certificate_holds(const Graph& graph, const Components& components,
                       const ContractionCertificate& certificate);

/// The objects along a closed walk by name, e.g. "a -> b -> a"; the middle of a long one is left out.
std::string describe_cycle(const Graph& graph, const std::vector<GraphStep>& cycle);

} // namespace graftal
