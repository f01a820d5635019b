#include "compiler/analysis/run_bounds.h"

#include <cmath>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"
#include "compiler/primitives/primitive.h"

namespace graftal {
namespace {

std::shared_ptr<const Run> random_run(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    auto run = std::make_shared<Run>();
    Vec3 at(0.0);
    while (run->size() < count) {
        RunItem item;
        item.base = at;
        item.axis = {unit(random), unit(random), unit(random)};
        item.radius = 0.3 + 0.2 * unit(random);
        item.shape = run->size() % 5 == 0 ? PrimitiveKind::sphere : tapered(0.5 + 0.5 * unit(random));
        item.ball = run->size() % 3 == 0 && item.shape == PrimitiveKind::cylinder;
        if (!item.shape.is_sphere()) at += item.axis;
        run->add(item);
    }
    return run;
}

/// The support function of all parts, each as the primitive that it is.
double plain_support(const Run& run, Vec3 direction) {
    double most = -1e300;
    const auto add = [&](const Primitive& kind, const Affine& place) {
        most = std::max(most, glm::dot(direction, place.translation) +
                                  primitive_support(kind, glm::transpose(place.linear) * direction));
    };
    for (std::size_t i = 0; i < run.size(); ++i) {
        Affine body = run_from_body(run[i]);
        if (run[i].shape.is_sphere()) body.linear = Mat3(run[i].radius);
        add(run[i].shape.primitive(), body);
        if (run[i].ball) add(PrimitiveKind::sphere, run_from_ball(run[i]));
    }
    return most;
}

class RunBoundsTest : public ::testing::TestWithParam<std::size_t> {};

TEST_P(RunBoundsTest, SupportIsThatOfTheParts) {
    const auto run = random_run(GetParam(), 7);
    const RunBounds bounds(run);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 50; ++i) {
        const Vec3 direction(normal(random), normal(random), normal(random));
        const double expected = plain_support(*run, direction);
        EXPECT_NEAR(glm::dot(direction, bounds.support_point(direction)), expected,
                    1e-11 * (1 + std::abs(expected)));
    }
}

TEST_P(RunBoundsTest, BoxTouchesTheParts) {
    const auto run = random_run(GetParam(), 8);
    const RunBounds bounds(run);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 direction(0.0);
        direction[axis] = 1;
        const double most = plain_support(*run, direction), least = -plain_support(*run, -direction);
        EXPECT_NEAR(bounds.box().max[axis], most, 1e-12 * (1 + std::abs(most)));
        EXPECT_GE(bounds.box().max[axis], most);
        EXPECT_NEAR(bounds.box().min[axis], least, 1e-12 * (1 + std::abs(least)));
        EXPECT_LE(bounds.box().min[axis], least);
    }
}

TEST_P(RunBoundsTest, BallHoldsAllAndIsSmall) {
    const auto run = random_run(GetParam(), 9);
    const RunBounds bounds(run);
    const Ball ball = bounds.ball();
    double thickest = 0; // the least ball is as large as the model is wide at least
    for (int i = 0; i < 400; ++i) {
        const double y = 1 - (2 * i + 1) / 400.0, r = std::sqrt(1 - y * y), a = 2.399963 * i;
        const Vec3 direction(r * std::cos(a), y, r * std::sin(a));
        const double reach = plain_support(*run, direction), back = plain_support(*run, -direction);
        EXPECT_LE(reach, glm::dot(direction, ball.centre) + ball.radius * (1 + 1e-12));
        thickest = std::max(thickest, 0.5 * (reach + back));
    }
    EXPECT_GE(ball.radius, thickest);
    EXPECT_LE(ball.radius, 1.16 * thickest); // Jung's theorem: sqrt(4/3) at most in space
}

TEST_P(RunBoundsTest, RangesHoldTheirItems) {
    const auto run = random_run(GetParam(), 10);
    const RunBounds bounds(run);
    for (std::size_t level = 0; level < bounds.level_count(); ++level)
        for (std::size_t i = 0; i < run->size(); ++i) {
            Box both = bounds.boxes(level)[i / RunBounds::range_size(level)];
            const Box range = both;
            both.include(box_of((*run)[i]));
            ASSERT_EQ(both, range) << "item " << i << " at level " << level;
        }
    EXPECT_EQ(bounds.boxes(bounds.level_count() - 1).size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Sizes, RunBoundsTest, ::testing::Values(1, 2, 31, 33, 300, 5000));

} // namespace
} // namespace graftal
