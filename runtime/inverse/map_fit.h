#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/inverse/attractor.h"
#include "runtime/inverse/copies.h"

namespace graftal {

/// Moves the maps of a system until its attractor equals a target, piece by piece; it adds, drops and
/// exchanges none. First, maps climb to copies of the target near them (CopySearch), each towards the part of
/// the edge that is nearest to its image, and all are refined together. Then random steps climb the agreement
/// itself, as in search(). Work is counted: maps depend on target, start, work and seed, not on the number of
/// workers.
class MapFit {
  public:
    /// Requires contractions, in cells of the target's grid, at least one and at most 255. The target
    /// outlives it. `seconds`: of one processor, by counted work.
    MapFit(const Target& target, PlaneMaps start, double seconds, std::uint64_t seed = 1);

    /// One piece, of some hundredths of a second as a rule. False when all is done, or the flag is raised.
    bool step(const Workers& workers, const CancelFlag& cancel);

    double fraction() const; ///< of the work allowed, at most 1
    double seconds() const;
    const PlaneMaps& maps() const { return best_.maps; } ///< the best so far; the start while none is better
    /// Agreement of these, without the Chamfer distance.
    const SetAgreement& agreement() const { return best_.agreement; }

  private:
    struct System {
        PlaneMaps maps;
        double value = -1;
        SetAgreement agreement;
    };

    template<typename Work> void tasks(std::size_t count, const Workers& workers, const Work& work);
    System judged(AttractorPainter& painter, PlaneMaps maps, std::uint64_t& work) const;
    void keep(std::vector<System> systems);
    std::uint64_t snap(PlaneMaps& maps, std::size_t which, Draws& draws) const;
    void snap_maps(const Workers& workers);
    void climb(const Workers& workers);

    const Target& target_;
    MapRules rules_;
    CopySearch<PlaneMap> copies_;
    double most_seconds_;
    std::uint64_t seed_;
    LevelPoints<PlaneMap> points_;
    std::vector<std::unique_ptr<AttractorPainter>> painters_; ///< one a worker
    System best_;
    int stalled_ = 0;    ///< batches of steps since the agreement was enough
    double step_ = 0.01; ///< of the random steps
    std::uint64_t batches_ = 0, work_ = 0;
};

} // namespace graftal
