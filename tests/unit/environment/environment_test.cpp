// What environments answer, against brute force where that is another way.

#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/environment/environment.h"
#include "compiler/support/counter_random.h"

namespace graftal::testing {
namespace {

using Kind = EnvironmentSettings::Kind;

/// Queries at places, each with the same values.
struct Asked {
    Asked(const EnvironmentSettings& settings, const std::vector<Vec3>& where,
          const std::vector<double>& told)
        : places(where), values(where.size(), told), environment(make_environment(settings, diagnostics)) {}

    void ask() {
        std::vector<EnvironmentQuery> queries;
        for (std::size_t i = 0; i < places.size(); ++i)
            queries.push_back({places[i], values[i]});
        answered = environment && environment->answer(queries);
    }

    std::vector<Vec3> places;
    std::vector<std::vector<double>> values;
    Diagnostics diagnostics;
    std::unique_ptr<GrowthEnvironment> environment;
    bool answered = false;
};

std::vector<Vec3> scattered(std::size_t count, double size) {
    const CounterRandom random(5);
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < count; ++i)
        places.push_back(size * Vec3(CounterRandom::unit(random(3 * i)),
                                     CounterRandom::unit(random(3 * i + 1)),
                                     CounterRandom::unit(random(3 * i + 2))));
    return places;
}

TEST(Environment, RegionsAnswerTheDistanceFromTheirUnion) {
    EnvironmentSettings settings;
    settings.regions = {{.kind = EnvironmentRegion::Kind::sphere, .a = Vec3(0, 0, 0), .extent = 2},
                        {.kind = EnvironmentRegion::Kind::box, .a = Vec3(3, 0, 0), .b = Vec3(5, 1, 1)},
                        {.kind = EnvironmentRegion::Kind::half_space, .a = Vec3(0, 1, 0), .extent = -10}};
    Asked asked(settings, {{0, 0, 0}, {0, 3, 0}, {4, 0.5, 0.5}, {6, 2, 0.5}, {0, -12, 0}, {2.5, 0.5, 0.5}},
                {7});
    asked.ask();
    ASSERT_TRUE(asked.answered);
    const std::array<double, 6> wanted = {-2, 1, -0.5, std::sqrt(2.0), -2, 0.5};
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_NEAR(asked.values[i][0], wanted[i], 1e-12) << i;
}

TEST(Environment, ACrowdLeavesTheStrongestAlone) {
    EnvironmentSettings settings{.kind = Kind::crowd};
    settings.radius = 1;
    Asked asked(settings, scattered(400, 12), {1, 0});
    for (std::size_t i = 0; i < asked.values.size(); ++i)
        asked.values[i] = {static_cast<double>(i % 5), static_cast<double>(i % 2)};
    const auto told = asked.values;
    asked.ask();
    ASSERT_TRUE(asked.answered);
    int free = 0;
    for (std::size_t i = 0; i < told.size(); ++i) {
        double wanted = 1;
        for (std::size_t j = 0; j < told.size(); ++j)
            if (i != j && told[i][1] == told[j][1] && told[j][0] >= told[i][0] &&
                glm::length(asked.places[i] - asked.places[j]) <= 1)
                wanted = 0;
        EXPECT_EQ(asked.values[i][0], wanted) << i;
        free += wanted == 1;
    }
    EXPECT_GT(free, 50);
    EXPECT_LT(free, 350);
}

TEST(Environment, AFlatCrowdTakesNoNoticeOfHeight) {
    EnvironmentSettings settings{.kind = Kind::crowd};
    settings.radius = 1;
    const std::vector<Vec3> above = {{0, 0, 0}, {0.5, 9, 0}};
    Asked space(settings, above, {1});
    space.ask();
    EXPECT_EQ(space.values[0][0], 1);
    settings.flat = Vec3(0, 1, 0);
    Asked flat(settings, above, {1});
    flat.ask();
    EXPECT_EQ(flat.values[0][0], 0);
}

TEST(Environment, OfRivalsTheLargerStays) {
    EnvironmentSettings settings{.kind = Kind::rivals};
    Asked asked(settings, {{0, 0, 0}, {3, 0, 0}, {9, 0, 0}}, {1});
    asked.values = {{1}, {2}, {1}};
    asked.ask();
    EXPECT_EQ(asked.values[0][0], 0);
    EXPECT_EQ(asked.values[1][0], 1);
    EXPECT_EQ(asked.values[2][0], 1);
}

TEST(Environment, BallsShadeWhatStandsBehindThem) {
    EnvironmentSettings settings{.kind = Kind::shade};
    settings.transmittance = 0.25;
    settings.sources = {{Vec3(0, 1, 0), 1}};
    // One above the other, one half beside, one far off.
    Asked asked(settings, {{0, 0, 0}, {0, 5, 0}, {30, 0, 0}}, {1, 0, 0, 0});
    asked.ask();
    EXPECT_NEAR(asked.values[0][0], 0.25, 1e-12);
    EXPECT_NEAR(asked.values[1][0], 1, 1e-12);
    EXPECT_NEAR(asked.values[2][0], 1, 1e-12);
    EXPECT_NEAR(asked.values[2][2], 1, 1e-12); // the brightest direction is up
    // Two discs of radius 1 whose centres lie 1 apart share 2 acos(1/2) - sqrt(3)/2.
    Asked half(settings, {{0, 0, 0}, {1, 5, 0}}, {1});
    half.ask();
    const double shared = (2 * std::acos(0.5) - std::sqrt(3.0) / 2) / std::acos(-1.0);
    EXPECT_NEAR(half.values[0][0], 1 - 0.75 * shared, 1e-12);
    // Under the whole sky a lone ball hears all of it.
    settings.sources.clear();
    Asked alone(settings, {{0, 0, 0}}, {1, 0, 0, 0});
    alone.ask();
    EXPECT_NEAR(alone.values[0][0], 1, 1e-12);
    EXPECT_GT(alone.values[0][2], 0.99);
}

TEST(Environment, ShadowsFallUponTheVoxelsBelow) {
    EnvironmentSettings settings{.kind = Kind::shadows};
    settings.voxel = 1;
    settings.strength = 0.5;
    settings.decay = 2;
    settings.depth = 2;
    Asked asked(settings, {{0.5, 5.5, 0.5}, {0.5, 4.5, 0.5}, {1.5, 3.5, 0.5}, {0.5, 2.5, 0.5}, {9, 9, 9}},
                {1});
    asked.values[4] = {1, 0, 0, 0};
    asked.ask();
    EXPECT_NEAR(asked.values[0][0], 1, 1e-12);                // nothing above
    EXPECT_NEAR(asked.values[1][0], 1 - 0.25, 1e-12);         // one voxel below the first
    EXPECT_NEAR(asked.values[2][0], 1 - 0.125 - 0.25, 1e-12); // two below the first, one below the second
    EXPECT_NEAR(asked.values[3][0], 1 - 0.125 - 0.25, 1e-12); // two below the second, one below the third
    EXPECT_NEAR(asked.values[4][0], 1, 1e-12);
}

/// Points in a ball of radius 1 about (0, 4, 0).
EnvironmentSettings points_in_a_ball(double influence, double kill) {
    EnvironmentSettings settings{.kind = Kind::points};
    settings.regions = {{.kind = EnvironmentRegion::Kind::sphere, .a = Vec3(0, 4, 0), .extent = 1}};
    settings.point_count = 200;
    settings.influence = influence;
    settings.kill = kill;
    settings.seed = 3;
    return settings;
}

TEST(Environment, PointsAttractUntilTheyAreReached) {
    Asked asked(points_in_a_ball(5, 0.5), {{0, 0, 0}, {0, 1, 0}, {40, 0, 0}}, {0, 0, 0, 0});
    asked.ask();
    ASSERT_TRUE(asked.answered);
    EXPECT_EQ(asked.values[0][0], 0) << "the other is nearer";
    EXPECT_EQ(asked.values[1][0], 200);
    EXPECT_GT(asked.values[1][2], 0.99);
    EXPECT_EQ(asked.values[2][0], 0);
    asked.places = {{0, 4, 0}, {0, 1, 0}, {40, 0, 0}};
    asked.ask();
    const double left = asked.values[0][0] + asked.values[1][0];
    EXPECT_LT(left, 200);
    EXPECT_GT(left, 100); // an eighth of the sphere's volume is gone
}

TEST(Environment, PointsAreGoneWithinReachThatIsLargerThanTheirInfluence) {
    Asked asked(points_in_a_ball(0.5, 5.5), {{0, 0, 0}}, {0, 0, 0, 0});
    asked.ask();
    asked.places = {{0, 4, 0}};
    asked.ask();
    EXPECT_EQ(asked.values[0][0], 0) << "all lay within 5.5 of the first query";
}

TEST(Environment, PointsNeedRoom) {
    EnvironmentSettings settings{.kind = Kind::points};
    settings.regions = {{.kind = EnvironmentRegion::Kind::sphere, .a = Vec3(0), .extent = 1e-6},
                        {.kind = EnvironmentRegion::Kind::sphere, .a = Vec3(1e6), .extent = 1e-6}};
    settings.point_count = 10;
    settings.influence = 1;
    Diagnostics diagnostics;
    EXPECT_EQ(make_environment(settings, diagnostics), nullptr);
    EXPECT_TRUE(diagnostics.has_errors());
}

TEST(Environment, TheBudgetIsKept) {
    Diagnostics diagnostics;
    EnvironmentBudget budget(diagnostics, Span());
    EXPECT_TRUE(budget.take(max_environment_work));
    EXPECT_FALSE(budget.take(1));
    EXPECT_FALSE(budget.take(1));
    EXPECT_EQ(diagnostics.error_count(), 1U);
}

TEST(Environment, FarPlacesAreNoHarm) {
    for (const Kind kind : {Kind::crowd, Kind::rivals, Kind::shade, Kind::shadows}) {
        EnvironmentSettings settings{.kind = kind};
        settings.radius = 1e-100;
        settings.voxel = 1e-100;
        settings.depth = 3;
        Asked asked(settings, {{1e100, -1e100, 0}, {0, 0, 0}, {-1e100, 1, 1}}, {1, 0, 0, 0});
        asked.ask();
        EXPECT_TRUE(asked.answered);
        for (const auto& values : asked.values)
            EXPECT_TRUE(std::isfinite(values[0]));
    }
}

} // namespace
} // namespace graftal::testing
