#pragma once

#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/symmetry.h"
#include "compiler/scene/scene.h"
#include "compiler/support/control.h"

namespace graftal {

/// Shares of light that make up for the shade that culled parts throw on themselves: stand-ins hardly do. A
/// part that measures 2^k of `lit_as_px` gets the power k of its object's share: each level of a fractal
/// takes the same share of the light. So the picture of any error has the light of the default one.
class SelfShadows {
  public:
    /// Size of a part that shows its own light: the default error.
    static constexpr double lit_as_px = 0.5;

    SelfShadows() = default;
    /// `octave_logs`: by node the logarithm to base 2 of the share for twice the size. `steps`: shares are
    /// rounded to 1 / steps. `work`: the cost of measuring them.
    SelfShadows(std::vector<float> octave_logs, int steps, std::uint64_t work)
        : octave_logs_(std::move(octave_logs)), steps_(steps), work_(work) {}

    /// The share of the light of lamps, suns and the sky that is left where a part of this diameter is
    /// culled. 1 up to `lit_as_px`.
    double share(NodeId node, double size_px) const;

    /// The share of a stand-in by its place: `outer`, the share of a culled part above it, if that is less
    /// than 1; else its node's own if its detail, a length in errors, is at most 1.
    double share_within(double outer, NodeId node, double detail, double error_px) const;

    /// Parts that rays went by to measure them.
    std::uint64_t work() const { return work_; }

  private:
    std::vector<float> octave_logs_;
    int steps_ = 1;
    std::uint64_t work_ = 0;
};

inline constexpr std::uint64_t most_self_shadow_work = 8'000'000;

/// Measures the shares for the lights and the camera of a view: some thousands of camera rays meet the parts
/// once as they are culled at `measured_px`, and once as at SelfShadows::lit_as_px, both in their own
/// shadows. An object's share makes the mean light that its parts scatter equal: a leaf that stands alone
/// lets light through, and the solid that stands for it does not. Objects that few rays meet take the mean of
/// all. Shares are rounded to `steps`. Ambient light does not count; of light from all directions a list
/// stands for it. Nothing is measured without lights that throw shadows.
///
/// Requires fit_proxies(). Work: at most `most_work` parts are gone by. The flag ends it by Cancelled.
SelfShadows measure_self_shadows(const DetailGraph& cut, const Symmetry& symmetry, std::uint32_t root_steps,
                                 const View& view, bool limit_normals, int steps,
                                 std::uint64_t most_work = most_self_shadow_work,
                                 const CancelFlag& cancel = {});

/// Self-shadows may take so much of the work allowed for a picture.
std::uint64_t self_shadow_work(double work_seconds);

inline constexpr double self_shadow_measured_px = 4;

/// Measures when it is first asked, by whichever thread.
class SelfShadowStore {
  public:
    template<typename Measure> const SelfShadows& get(const Measure& measure) {
        std::call_once(once_, [&] { shadows_ = measure(); });
        return shadows_;
    }

  private:
    std::once_flag once_;
    SelfShadows shadows_;
};

} // namespace graftal
