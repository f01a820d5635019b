#include "compiler/detail/shell/inside_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

using Point = std::array<float, 3>;

/// find_inside() by its definition: a flood cell by cell, then all neighbours of each dry cell.
class Reference {
  public:
    Reference(const std::vector<Point>& points, double cell, int reach, const InsideGrid* known)
        : cell_(cell), reach_(reach), side_(2 * reach),
          state_(static_cast<std::size_t>(side_ * side_ * side_)) {
        for (const Point& p : points)
            at(place(p[0]), place(p[1]), place(p[2])) = dry;
        for (int z = 0; known && z < side_; ++z)
            for (int y = 0; y < side_; ++y)
                for (int x = 0; x < side_; ++x)
                    if (known->has(middle(x, y, z))) at(x, y, z) = dry;
        std::vector<std::array<int, 3>> front = {{0, 0, 0}};
        at(0, 0, 0) = wet;
        while (!front.empty()) {
            const std::array<int, 3> here = front.back();
            front.pop_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const int step : {-1, 1}) {
                    std::array<int, 3> next = here;
                    next[axis] += step;
                    if (next[axis] < 0 || next[axis] >= side_) continue;
                    char& there = at(next[0], next[1], next[2]);
                    if (there != empty) continue;
                    there = wet;
                    front.push_back(next);
                }
        }
    }

    bool is_inside(int x, int y, int z) {
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int n[] = {x + dx, y + dy, z + dz};
                    for (const int c : n)
                        if (c < 0 || c >= side_) return false;
                    if (at(n[0], n[1], n[2]) == wet) return false;
                }
        return true;
    }

    Point middle(int x, int y, int z) const {
        const auto m = [&](int i) { return static_cast<float>(cell_ * (i - reach_ + 0.5)); };
        return {m(x), m(y), m(z)};
    }
    int side() const { return side_; }

  private:
    static constexpr char empty = 0, dry = 1, wet = 2;
    int place(float coordinate) const {
        return static_cast<int>(std::floor(static_cast<double>(coordinate) / cell_)) + reach_;
    }
    char& at(int x, int y, int z) { return state_[static_cast<std::size_t>((z * side_ + y) * side_ + x)]; }

    double cell_;
    int reach_, side_;
    std::vector<char> state_;
};

/// Spheres, some with holes, some in each other.
std::vector<Point> hollow_balls(std::mt19937_64& random) {
    const auto between = [&](double least, double most) {
        return least + (most - least) * std::ldexp(static_cast<double>(random() >> 11), -53);
    };
    std::vector<Point> points;
    const int balls = static_cast<int>(random() % 3) + 1;
    for (int ball = 0; ball < balls; ++ball) {
        const double radius = between(4, 12), hole = between(-0.5, 0.6);
        const double offset = between(-6, 6);
        for (int i = 0; i < 6000; ++i) {
            const double z = between(-1, 1), turn = between(0, 6.2832);
            if (z > 1 - hole) continue;
            const double r = std::sqrt(1 - z * z);
            points.push_back({static_cast<float>(radius * r * std::cos(turn) + offset),
                              static_cast<float>(radius * r * std::sin(turn)),
                              static_cast<float>(radius * z)});
        }
    }
    return points;
}

TEST(InsideGrid, IsWhatLiesACellBehindTheFlood) {
    std::mt19937_64 random(3);
    int enclosed = 0, open = 0;
    for (int i = 0; i < 30; ++i) {
        const std::vector<Point> points = hollow_balls(random);
        float far = 0;
        for (const Point& point : points)
            for (const float c : point)
                far = std::max(far, std::abs(c));
        std::shared_ptr<const InsideGrid> known;
        for (const double cell : {1.6, 1.0}) {
            const int reach = static_cast<int>(far / cell) + 3;
            Reference reference(points, cell, reach, known.get());
            std::uint64_t work = 0;
            const auto inside = find_inside(points, cell, known.get(), work);
            EXPECT_GT(work, 0u);
            int count = 0;
            for (int z = 0; z < reference.side(); ++z)
                for (int y = 0; y < reference.side(); ++y)
                    for (int x = 0; x < reference.side(); ++x) {
                        const bool expected = reference.is_inside(x, y, z);
                        count += expected;
                        ASSERT_EQ(inside && inside->has(reference.middle(x, y, z)), expected)
                            << i << ": " << x << ", " << y << ", " << z;
                    }
            EXPECT_EQ(inside != nullptr, count > 0);
            ++(count > 0 ? enclosed : open);
            known = inside;
        }
    }
    EXPECT_GE(enclosed, 10);
    EXPECT_GE(open, 10);
}

} // namespace
} // namespace graftal
