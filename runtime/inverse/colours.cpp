#include "runtime/inverse/colours.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "runtime/image/develop.h"

namespace graftal {

namespace {

constexpr std::uint32_t no_point = UINT32_MAX;
/// Weight of a grey tint for each map, in cells: maps of a few hidden cells get no colour of their own.
constexpr double weight_of_grey = 1;

/// The attractor's points, one a cell, and how each came from another.
class ColouredPoints {
  public:
    ColouredPoints(const Target& target, const PlaneMaps& maps) : maps_(maps.size()) {
        const auto width = static_cast<std::size_t>(target.width());
        std::vector<std::uint32_t> point_in(width * static_cast<std::size_t>(target.height()), no_point);
        std::vector<Vec2> queue(1, fixed_point(maps.front()));
        steps_.push_back({0, 0});
        for (std::uint32_t i = 0; i < queue.size(); ++i)
            for (std::uint32_t m = 0; m < maps_; ++m) {
                const Vec2 q = maps[m](queue[i]);
                if (!(q.x >= 0 && q.y >= 0 && q.x < target.width() && q.y < target.height())) continue;
                const std::size_t cell =
                    static_cast<std::size_t>(q.y) * width + static_cast<std::size_t>(q.x);
                if (point_in[cell] != no_point) continue;
                point_in[cell] = static_cast<std::uint32_t>(queue.size());
                queue.push_back(q);
                steps_.push_back({i, m});
            }
        for (std::size_t k = 0; k < target.points().size(); ++k) {
            const Vec2 p = target.points()[k];
            const std::uint32_t point =
                point_in[static_cast<std::size_t>(p.y) * width + static_cast<std::size_t>(p.x)];
            if (point != no_point) seen_.push_back({point, k});
        }
    }

    SystemColours fit(const std::vector<Rgb>& colours, double alpha) const {
        // Shares of the maps' tints in each point's colour.
        const auto count = static_cast<Eigen::Index>(maps_);
        Eigen::MatrixXd shares(count, static_cast<Eigen::Index>(steps_.size()));
        shares.col(0).setConstant(1.0 / static_cast<double>(maps_));
        for (std::size_t i = 1; i < steps_.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            shares.col(column) = (1 - alpha) * shares.col(steps_[i].from);
            shares(steps_[i].map, column) += alpha;
        }
        Eigen::MatrixXd products = weight_of_grey * Eigen::MatrixXd::Identity(count, count);
        Eigen::MatrixXd sums = Eigen::MatrixXd::Constant(count, 3, 0.5 * weight_of_grey);
        for (const Seen& seen : seen_) {
            const auto share = shares.col(seen.point);
            products += share * share.transpose();
            for (int c = 0; c < 3; ++c)
                sums.col(c) += colours[seen.target][c] * share;
        }
        const Eigen::MatrixXd tints = products.ldlt().solve(sums).cwiseMax(0.0).cwiseMin(1.0);
        SystemColours result{{}, alpha, 0};
        for (Eigen::Index m = 0; m < count; ++m)
            result.of_map.emplace_back(tints(m, 0), tints(m, 1), tints(m, 2));
        double squares = 0;
        for (const Seen& seen : seen_) {
            const Eigen::Vector3d shown = tints.transpose() * shares.col(seen.point);
            for (int c = 0; c < 3; ++c)
                squares +=
                    std::pow(255 * (developed(shown[c], {}) - developed(colours[seen.target][c], {})), 2);
        }
        result.rms_255 = seen_.empty() ? 0 : std::sqrt(squares / (3 * static_cast<double>(seen_.size())));
        return result;
    }

  private:
    struct Step {
        std::uint32_t from, map; ///< the point that this map took here
    };
    struct Seen {
        std::uint32_t point;
        std::size_t target;
    };

    std::size_t maps_;
    std::vector<Step> steps_;
    std::vector<Seen> seen_; ///< points in the target's cells
};

} // namespace

SystemColours fit_colours(const Target& target, const PlaneMaps& maps, const std::vector<Rgb>& colours) {
    const ColouredPoints points(target, maps);
    SystemColours best;
    for (const double alpha : {1.0, 0.8, 0.65, 0.5, 0.35, 0.2}) {
        SystemColours fitted = points.fit(colours, alpha);
        if (best.of_map.empty() || fitted.rms_255 < best.rms_255) best = std::move(fitted);
    }
    return best;
}

} // namespace graftal
