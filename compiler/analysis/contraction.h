#pragma once

#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// One step of a path in the graph: instance number `instance` of object `object`.
struct GraphStep {
    ObjectId object = 0;
    std::uint32_t instance = 0;
    bool operator==(const GraphStep&) const = default;
};

enum class Verdict { acyclic, proved, refuted, undecided };

/// A checkable reason why every cycle contracts: for each object of a cycle a metric P = L^T L in which every
/// path of `depth` instances within its component shrinks lengths by rate^depth at least. Depth 1 is the
/// usual case; identity metrics with depth 1 say that every instance contracts as it stands.
struct ContractionCertificate {
    std::vector<Mat3> metric;    ///< L by object, upper triangular; the identity outside cycles
    std::vector<double> weight;  ///< p_v > 0 by object: |L_v A_e L_u^-1| p_u <= rate p_v for v <- u at depth 1
    double rate = 0;             ///< < 1
    int depth = 1;
};

/// Whether the unfolding converges. `lower` and `upper` enclose the joint spectral radius of the
/// component that contracts least (constrained to its paths), the factor a level contributes in the long run.
struct Contraction {
    Verdict verdict = Verdict::acyclic;
    double lower = 0;
    double upper = 0;
    std::vector<GraphStep> worst_cycle;  ///< the cycle that gives `lower`, from an object back to itself
    ContractionCertificate certificate;  ///< of a PROVED verdict

    /// The figure to print: the spectral radius of the worst cycle, per instance.
    double rate() const { return lower; }
};

/// Decides by the cycle mean of norms, one linear solve for metrics, then Gripenberg's branch and bound over
/// paths (research notes, Karp 1978, Gripenberg 1996). Effort is bounded: what it cannot settle it calls
/// undecided, with the interval reached. A refutation names a cycle whose spectral radius is at least 1.
Contraction decide_contraction(const Graph& graph, const Components& components);

/// Re-checks a certificate from the graph alone, by other means than those that found it.
bool certificate_holds(const Graph& graph, const Components& components,
                       const ContractionCertificate& certificate);

}  // namespace graftal
