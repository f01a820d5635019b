// The IFS scenes against what is known of their sets: each is walked down to small pieces, and compared, both
// ways, with points of a chaos game over maps that are typed in here once more.

#include <cmath>
#include <cstdint>
#include <functional>
#include <ostream>
#include <random>
#include <string>
#include <unordered_map>

#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/support/bounds.h"
#include "tests/unit/languages/lower_file.h"

namespace graftal {
namespace {

using Point = Vec3;
using Maps = std::vector<std::function<Point(Point)>>;

struct Known {
    std::string file;
    Maps maps;
    std::vector<double> weights; ///< empty: equal
    bool no_repeats = false;     ///< of the pound sign
    Box box;                     ///< exact
    double largest = 1;          ///< object, in terms of the whole set
};

Affine flat(double a, double b, double c, double d, double e, double f) {
    return {Mat3(a, c, 0, b, d, 0, 0, 0, 0), {e, f, 0}};
}

/// x -> s x + (1 - s) corner for each corner.
Maps towards(const std::vector<Point>& corners, double s) {
    Maps maps;
    for (const Point corner : corners)
        maps.push_back([=](Point p) { return s * p + (1 - s) * corner; });
    return maps;
}

/// The points of {-1, 0, 1}^3 with at most `most_zeros` zeros; flat ones have z = 0.
std::vector<Point> lattice(int most_zeros, bool is_flat) {
    std::vector<Point> points;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if ((!is_flat || z == 0) && (x == 0) + (y == 0) + (!is_flat && z == 0) <= most_zeros)
                    points.push_back(Point(x, y, z));
    return points;
}

std::vector<Point> icosahedron() {
    const double phi = (1 + std::sqrt(5.)) / 2;
    std::vector<Point> corners;
    for (const double one : {-1., 1.})
        for (const double far : {-phi, phi}) {
            corners.push_back({0, one, far});
            corners.push_back({far, 0, one});
            corners.push_back({one, far, 0});
        }
    return corners;
}

/// Sponges of crosses: the maps of two levels at once.
Maps sponge_of_crosses() {
    std::vector<Point> inner = lattice(0, false);
    inner.push_back(Point(0));
    Maps maps;
    for (const Point a : lattice(1, false))
        for (const Point b : inner)
            maps.push_back([=](Point p) { return (p / 3. + 2. / 3 * b) / 3. + 2. / 3 * a; });
    return maps;
}

std::vector<Known> known_scenes() {
    const double h = std::sqrt(3.) / 6;
    const double phi = (1 + std::sqrt(5.)) / 2;
    const double r = 1 / (1 + phi);
    const Box cube = {Point(-1), Point(1)};
    const Box square = {{-1, -1, 0}, {1, 1, 0}};
    const std::vector<double> fern = {.03, .73, .12, .12};
    return {
        {"hart/pound_sign_2d", towards(lattice(0, true), .5), {}, true, square},
        {"hart/pound_sign", towards(lattice(0, false), .5), {}, true, cube},
        {"ifs/sierpinski_tetrahedron",
         towards({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, .5),
         {},
         false,
         cube},
        {"ifs/menger_sponge", towards(lattice(1, false), 1. / 3), {}, false, cube},
        {"ifs/sierpinski_carpet", towards(lattice(1, true), 1. / 3), {}, false, square},
        {"ifs/graph_directed", sponge_of_crosses(), {}, false, cube},
        {"ifs/expanding_edge", towards(icosahedron(), r), {}, false, {Point(-phi), Point(phi)}, 2},
        {"ifs/koch_curve",
         {flat(1. / 3, 0, 0, 1. / 3, 0, 0), flat(1. / 6, -h, h, 1. / 6, 1. / 3, 0),
          flat(1. / 6, h, -h, 1. / 6, .5, h), flat(1. / 3, 0, 0, 1. / 3, 2. / 3, 0)},
         {},
         false,
         {{0, 0, 0}, {1, h, 0}}},
        {"ifs/twin_dragon",
         {flat(.5, -.5, .5, .5, 0, 0), flat(.5, -.5, .5, .5, 1, 0)},
         {},
         false,
         {{-2. / 3, -1. / 3, 0}, {5. / 3, 4. / 3, 0}}},
        {"ifs/heighway_dragon",
         {flat(.5, -.5, .5, .5, 0, 0), flat(-.5, -.5, .5, -.5, 1, 0)},
         {},
         false,
         {{-1. / 3, -1. / 3, 0}, {7. / 6, 2. / 3, 0}}},
        {"ifs/levy_curve",
         {flat(.5, -.5, .5, .5, 0, 0), flat(.5, .5, -.5, .5, .5, .5)},
         {},
         false,
         {{-.5, -.25, 0}, {1.5, 1, 0}}},
        {"ifs/fern",
         {flat(0, 0, 0, .16, 0, 0), flat(.85, .04, -.04, .85, 0, 1.6), flat(.2, -.26, .23, .22, 0, 1.6),
          flat(-.15, .28, .26, .24, 0, .44)},
         fern,
         false,
         {{-2.1819, 0, 0}, {2.6558, 9.9983, 0}}},
        {"ifs/fern_3d",
         {[](Point p) { return Point(0, .18 * p.y, 0); },
          [](Point p) { return Point(.85 * p.x, .85 * p.y + .1 * p.z + 1.6, -.1 * p.y + .85 * p.z); },
          [](Point p) { return Point(.2 * (p.x - p.y), .2 * (p.x + p.y) + .8, .3 * p.z); },
          [](Point p) { return Point(.2 * (p.y - p.x), .2 * (p.x + p.y) + .8, .3 * p.z); }},
         fern,
         false,
         {{-1.623, 0, -4.999}, {1.623, 7.998, 0}}},
    };
}

/// Points of the set, seeded.
std::vector<Point> chaos_game(const Known& known, std::size_t count) {
    std::mt19937 random(7);
    std::vector<double> weights = known.weights;
    if (weights.empty()) weights.assign(known.maps.size(), 1);
    std::discrete_distribution<std::size_t> choose(weights.begin(), weights.end());
    std::vector<Point> points;
    Point p = known.box.centre();
    std::size_t last = known.maps.size();
    for (std::size_t i = 0; i < count + 100; ++i) {
        std::size_t map = choose(random);
        while (known.no_repeats && map == last)
            map = choose(random);
        last = map;
        p = known.maps[map](p);
        if (i >= 100) points.push_back(p);
    }
    return points;
}

/// The middles of pieces that are at most `size` large, of which the graph's set is the union.
std::vector<Point> pieces(const Graph& graph, const Known& known, double size) {
    struct Piece {
        ObjectId object;
        Affine world_from_object;
    };
    const double diameter = known.largest * glm::length(known.box.size());
    std::vector<Piece> stack = {{graph.root, Affine()}};
    std::vector<Point> middles;
    while (!stack.empty()) {
        const Piece piece = stack.back();
        stack.pop_back();
        const Object& object = graph.objects[piece.object];
        if (norm(piece.world_from_object.linear) * diameter <= size) {
            middles.push_back(piece.world_from_object(known.box.centre()));
            continue;
        }
        for (const Instance& instance : object.instances)
            stack.push_back({instance.master, piece.world_from_object * instance.parent_from_child});
    }
    return middles;
}

/// The share of `from` that has no point of `to` within `reach`.
double share_out_of_reach(const std::vector<Point>& from, const std::vector<Point>& to, double reach) {
    const auto cell = [&](Point p, int x, int y, int z) {
        const auto at = [&](double v, int d) {
            return static_cast<std::int64_t>(std::floor(v / reach)) + d + (1 << 19);
        };
        return (at(p.x, x) << 40) ^ (at(p.y, y) << 20) ^ at(p.z, z);
    };
    std::unordered_map<std::int64_t, std::vector<Point>> grid;
    for (const Point p : to)
        grid[cell(p, 0, 0, 0)].push_back(p);
    const auto reached = [&](Point p) {
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    if (const auto there = grid.find(cell(p, x, y, z)); there != grid.end())
                        for (const Point q : there->second)
                            if (glm::length(p - q) <= reach) return true;
        return false;
    };
    std::size_t out = 0;
    for (const Point p : from)
        out += !reached(p);
    return static_cast<double>(out) / static_cast<double>(from.size());
}

void PrintTo(const Known& known, std::ostream* out) {
    *out << known.file;
}

class RifsScenes : public testing::TestWithParam<Known> {};

TEST_P(RifsScenes, setIsTheOneOfTheLiterature) {
    const Known& known = GetParam();
    SourceMap sources;
    Diagnostics diagnostics;
    Status status;
    const auto graph = test::lower_file(std::string(GRAFTAL_SOURCE_DIR) + "/scenes/" + known.file + ".rifs",
                                        {}, sources, diagnostics, status)
                           .graph;
    ASSERT_TRUE(graph) << status.message() << diagnostics.render(sources);
    EXPECT_EQ(diagnostics.render(sources), "");

    const double width = std::max({known.box.size().x, known.box.size().y, known.box.size().z});
    const double size = width / 12;
    const std::vector<Point> found = pieces(*graph, known, size);
    const std::vector<Point> points = chaos_game(known, 60'000);
    EXPECT_EQ(share_out_of_reach(points, found, size), 0);
    EXPECT_EQ(share_out_of_reach(found, points, 1.5 * size), 0);
    Box hull;
    for (const Point p : points)
        hull.include(p);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(hull.min[axis], known.box.min[axis], .03 * width) << axis;
        EXPECT_NEAR(hull.max[axis], known.box.max[axis], .03 * width) << axis;
    }
}

INSTANTIATE_TEST_SUITE_P(All, RifsScenes, testing::ValuesIn(known_scenes()), [](const auto& scene) {
    return scene.param.file.substr(scene.param.file.find('/') + 1);
});

} // namespace
} // namespace graftal
