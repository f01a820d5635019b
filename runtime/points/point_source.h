#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/chaos/chaos_game.h"
#include "compiler/chaos/flat_game.h"

namespace graftal {

/// Points one after the other.
class PointStream {
  public:
    virtual ~PointStream() = default;
    /// The next points, as many as there is room for; false if there are none: the sequence has gone astray,
    /// or was stopped.
    virtual bool fill(std::span<ChaosPoint> points) = 0;
};

/// Whether points are no longer wanted, which is asked now and then; empty: they are.
using Stopped = std::function<bool()>;

/// A source of points to draw.
class PointSource {
  public:
    virtual ~PointSource() = default;
    /// A sequence of its own for each number: threads may take them in any order.
    virtual std::unique_ptr<PointStream> stream(std::uint64_t number, const Stopped& stopped) const = 0;
    /// Whether there is one sequence only, number 0: each point follows from the one before.
    virtual bool single() const { return false; }
    /// The source for graphics cards (FlatGame::of()); nothing, and `why`, where they cannot make its points.
    virtual std::optional<FlatGame> flat(const Affine& seen_from_world, const LabelColour& colour_of,
                                         std::string& why) const = 0;
};

/// Random iteration on a graph. The game must outlive this.
class ChaosSource : public PointSource {
  public:
    ChaosSource(const ChaosGame& game, std::uint64_t seed) : game_(game), seed_(seed) {}
    std::unique_ptr<PointStream> stream(std::uint64_t number, const Stopped& stopped) const override;
    std::optional<FlatGame> flat(const Affine& seen_from_world, const LabelColour& colour_of,
                                 std::string& why) const override {
        return FlatGame::of(game_, seen_from_world, colour_of, why);
    }

  private:
    const ChaosGame& game_;
    std::uint64_t seed_;
};

/// The work of taking points from a source.
struct PointWork {
    std::uint64_t points = 0;
    int threads = 0; ///< 0: all processors
    std::function<void(double fraction)> on_progress;
    Stopped cancelled;
};

/// Points of one stream. All streams have this length, except the last.
inline constexpr std::uint64_t points_of_stream = 1u << 17;

/// Calls `take(worker, points)` for batches of points, all together those of the streams 0, 1, ... up to the
/// number. Batches come in any order, from several threads at a time, each with a number of its own below
/// worker_count(). False if it was cancelled, or a stream has gone astray: those before it go on, so that the
/// first that goes astray is always the same.
bool take_points(const PointSource& source, const PointWork& work,
                 const std::function<void(int worker, std::span<const ChaosPoint>)>& take);

/// Takes points as take_points() does, but one batch at a time and in order. `make` turns points into bytes,
/// on any thread; `write` gets them in order. False also if `write` fails.
bool write_points(const PointSource& source, const PointWork& work,
                  const std::function<void(std::span<const ChaosPoint>, std::vector<char>&)>& make,
                  const std::function<bool(const std::vector<char>&)>& write);

/// Number of threads that will be at work, or fewer.
int worker_count(int threads);

} // namespace graftal
