#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "compiler/rifs/orbit_model.h"
#include "compiler/support/bounds.h"
#include "runtime/points/point_source.h"

namespace graftal {

/// The points of an orbit: of one map a single sequence, of several any number, which all begin at the same
/// point. The model must outlive this.
class OrbitSource : public PointSource {
  public:
    OrbitSource(const OrbitModel& model, std::uint64_t seed);
    std::unique_ptr<PointStream> stream(std::uint64_t number, const Stopped& stopped) const override;
    bool single() const override { return model_.maps.size() == 1; }
    std::optional<FlatGame> flat(const Affine& seen_from_world, const LabelColour& colour_of,
                                 std::string& why) const override;

    struct Survey {
        Box box;
        double astray = 0; ///< the share of moves that go astray and begin again
    };
    /// The first points of the first sequence, or fewer if it was stopped.
    Survey survey(std::uint64_t points, const Stopped& stopped) const;
    /// Reports, if a sequence has gone astray, where and why; of several that have, the first.
    bool report(Diagnostics& diagnostics) const;

  private:
    class Stream;
    struct Astray {
        std::uint64_t stream = 0;
        std::uint64_t steps = 0;
        std::size_t map = 0; ///< OrbitModel::report()'s
        Vec3 before{0.0};
        bool has_value = false; ///< but too far away
        std::vector<double> draws;
    };

    void note(const Astray& astray) const;

    const OrbitModel& model_;
    std::uint64_t seed_;
    AliasTables tables_;
    std::vector<AliasTables::Range> choices_; ///< of the first map, then of those after each
    mutable std::mutex noting_;
    mutable std::optional<Astray> astray_;
};

} // namespace graftal
