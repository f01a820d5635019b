// Points by a device against those by the processors: as near as those of another seed.

#include "runtime/points/gpu_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "runtime/points/orbit_source.h"
#include "tests/unit/chaos/games.h"
#include "tests/unit/points/points_kernel.h"

namespace graftal {
namespace {

constexpr ImageSize small{48, 36};
constexpr std::uint64_t many = 400'000;

Camera camera_at(Vec3 middle, double width) {
    Camera camera;
    camera.orthographic = true;
    camera.location = middle + Vec3(0, 0, 1);
    camera.width = width;
    return camera;
}

std::unique_ptr<Accumulation> by_processors(const PointSource& source, const Camera& camera,
                                            std::uint64_t points = many) {
    auto picture = std::make_unique<Accumulation>(small);
    const PointProjection projection(camera, small);
    PointWork work;
    work.points = points;
    work.threads = 1;
    EXPECT_TRUE(take_points(source, work, [&](int, std::span<const ChaosPoint> some) {
        for (const ChaosPoint& point : some)
            if (const auto pixel = projection.pixel_of(point.place)) picture->add(*pixel, point.rgb);
    }));
    return picture;
}

std::unique_ptr<Accumulation> by_gpu(const PointSource& source, const Camera& camera,
                                     std::uint64_t points = many,
                                     GpuPoints::Sums sums = GpuPoints::Sums::packed, ImageSize size = small,
                                     std::uint64_t most_bytes = UINT64_MAX) {
    auto picture = std::make_unique<Accumulation>(size);
    const PointProjection projection(camera, size);
    std::string why;
    std::optional<FlatGame> game = source.flat(projection.picture_from_world(), {}, why);
    EXPECT_TRUE(game) << why;
    Status status;
    const std::unique_ptr<Gpu> gpu = Gpu::open(0, status);
    EXPECT_TRUE(gpu) << status.message();
    if (!gpu || !game) return picture;
    GpuPoints device(*gpu, gpu->info().atomics_64 ? sums : GpuPoints::Sums::apart);
    status = device.add_to(*picture, *game,
                           {.points = points,
                            .seed = 7,
                            .most_bytes = most_bytes,
                            .perspective = projection.perspective(),
                            .goes_on = [](double) { return true; }});
    EXPECT_TRUE(status.ok()) << status.message();
    return picture;
}

/// Points of the kernel's text as C++.
std::vector<std::uint32_t> by_text(const FlatGame& game, std::uint32_t points) {
    namespace text = points_kernel;
    text::game = &game;
    text::FLAT = game.flat;
    text::PERSPECTIVE = false;
    text::CHANNELS = 0;
    text::CLIMBS = game.climbs;
    text::LEAVES = game.leaves;
    text::WIDE = game.wide;
    text::SOURCES = game.sources.count > 0;
    text::FORMULAS = game.formulas;
    const auto last = static_cast<std::uint32_t>(game.colours.size() - 1);
    text::words.assign(static_cast<std::size_t>(small.width) * small.height, 0);
    text::job.window = {small.width, small.height, 0, small.height};
    text::job.start = {game.start.first, game.start.count, game.settling, last};
    text::job.orbit = {game.links.size() - 1, game.core_colour, game.first_form,
                       std::bit_cast<std::uint32_t>(game.restart)};
    text::job.sources = {game.sources.first, game.sources.count, 0, 0};
    text::job.more = {7, 0, text::words.size(), 1};
    constexpr std::uint32_t walkers = 128; // as few points have
    text::job.work = {walkers, points / walkers, points % walkers, JOB_BEGINS};
    for (std::uint32_t i = 0; i < walkers; ++i) {
        text::Walker walker = text::new_walker(i);
        text::played(i, walker);
    }
    return text::words;
}

std::uint64_t points_in(const Accumulation& picture) {
    std::uint64_t sum = 0;
    for (const Accumulation::Cell& cell : picture.cells())
        sum += cell.count;
    return sum;
}

/// How far pictures of as many points are from each other.
struct Distance {
    double counts = 0;  ///< a pixel, in what chance would give if points were independent: 1
    double colours = 0; ///< of means, a point
    double pixels = 0;  ///< that were compared
};

Distance distance(const Accumulation& a, const Accumulation& b) {
    Distance found;
    double points = 0;
    for (std::size_t i = 0; i < a.cells().size(); ++i) {
        const Accumulation::Cell &one = a.cells()[i], &other = b.cells()[i];
        const auto here = static_cast<double>(one.count), there = static_cast<double>(other.count);
        if (here + there < 20) continue;
        ++found.pixels;
        found.counts += (here - there) * (here - there) / (here + there);
        if (one.count == 0 || other.count == 0) continue;
        const Rgb apart = a.mean_colour(one) - b.mean_colour(other);
        points += here;
        found.colours += here * (std::abs(apart.r) + std::abs(apart.g) + std::abs(apart.b));
    }
    EXPECT_GT(found.pixels, 50);
    found.counts /= found.pixels;
    found.colours /= points;
    return found;
}

/// `other`: with another seed.
void expect_same_measure(const PointSource& source, const PointSource& other_source, const Camera& camera) {
    const auto one = by_processors(source, camera), other = by_processors(other_source, camera),
               gpu = by_gpu(source, camera);
    const Distance by_chance = distance(*one, *other), found = distance(*one, *gpu);
    // Five standard deviations of what chance gives of so many pixels.
    const double spread = 5 * std::sqrt(2 / found.pixels) * std::max(by_chance.counts, 1.0);
    EXPECT_NEAR(found.counts, by_chance.counts, spread);
    EXPECT_LT(found.colours, 1.2 * by_chance.colours + 1e-3);
}

void expect_same_measure(const std::string& name, const std::string& text, const Camera& camera) {
    const ChaosGame game = testing::played(name, text).game();
    expect_same_measure(ChaosSource(game, 1), ChaosSource(game, 2), camera);
}

const std::string fern = "rifs fern { codes 2d {\n stem: 0 0 0 .16 0 0 .01 tint rgb <.2, .1, 0> 0.9\n"
                         "frond: .85 .04 -.04 .85 0 1.6 .85 tint rgb <0, .4, 0> 0.06\n"
                         "left: .2 -.26 .23 .22 0 1.6 .07 tint rgb <1, .4, 0> 0.7\n"
                         "right: -.15 .28 .26 .24 0 .44 .07 tint rgb <.1, .4, 1> 0.7\n } }";

const std::string quadrants = "rifs p { map a { scale 1/2 tint rgb <1, 0, 0> 1/2 }\n"
                              "map b { scale 1/2 translate <1/2, 0, 1/2> tint rgb <0, 0, 1> 1/2 }\n"
                              "map c { scale 1/2 translate <0, 1/2, 1/2> }\n"
                              "map d { scale 1/2 translate <1/2, 1/2, 0> }\n follow all except self }";

TEST(GpuPoints, HaveTheMeasureOfTheProcessors) {
    expect_same_measure("a.rifs", fern, camera_at({0, 5, 0}, 14));
    expect_same_measure("a.rifs", quadrants, camera_at({0.5, 0.5, 0}, 1.4));
    Camera near;
    near.location = {0.5, 0.4, 2};
    expect_same_measure("a.rifs", quadrants, near);
}

/// A core that points leave from some states only, and climb from.
TEST(GpuPoints, ClimbFromCores) {
    expect_same_measure(
        "a.inst",
        "canonical object a { b scale: 0.5 chance: 1\n a scale: 0.5 translate: 1,0,0 chance: 2 }\n"
        "canonical object b { a scale: 0.5 translate: 0,1,0 chance: 1\n"
        " b scale: 0.4 translate: 1,1,0 chance: 3 tint: 1,0,0,0.5 }\n"
        "object top { a chance: 1\n a scale: 0.5 translate: 2,0,0 chance: 1 }",
        camera_at({1.4, 0.97, 0}, 4.1));
}

TEST(GpuPoints, AreOfSurfacesOfAllForms) {
    Camera askew = camera_at({0, 0, 0}, 9.3);
    askew.location = {-3, -2, -4};
    askew.direction = glm::normalize(-askew.location);
    askew.right = glm::normalize(glm::cross(askew.direction, Vec3(0, 1, 0)));
    askew.up = glm::cross(askew.right, askew.direction);
    const std::string polygon = "polygon(0,0, 1,0, 1,2, -1,1)";
    const std::pair<std::string, std::string> forms[] = {
        {"triangle", "sphere"}, {"cube", "torus"}, {"cylinder", "cone"}, {polygon, "frustum(0.4)"}};
    for (const auto& [one, other] : forms)
        expect_same_measure("a.inst",
                            "canonical object part { " + one + " scale: 2,0.5,1 tint: 0.3,0,0.1,0.5\n " +
                                other +
                                " scale: 0.7 translate: -2,1.5,0 }\nobject top { part tint: 1,0.8,0,0.2\n "
                                "part rotate: x, 40 translate: 2,-1.5,0 }",
                            askew);
}

TEST(GpuPoints, AreOfCondensationSetsAndCycles) {
    expect_same_measure("a.rifs",
                        "rifs c { map a { scale 0.6 rotate <0, 0, 1> 30 tint rgb <1, 0, 0> 0.3 }\n"
                        " map b { scale 0.5 translate <0.4, 0.1, 0> }\n"
                        "condense sphere scale <0.3, 0.1, 0.1> translate <1, 0, 0> }",
                        camera_at({0.6, 0.2, 0}, 1.9));
    expect_same_measure(
        "a.inst",
        "canonical object inner { inner scale: 0.5\ninner scale: 0.5 translate: 1,0,0 tint: 0,1,0,0.2 }\n"
        "canonical object outer { inner scale: 0.4\nouter scale: 0.5 translate: 0,2,0\n"
        "cube scale: 0.2 translate: 1,1,0 }\nobject top { outer }",
        camera_at({0.5, 1.5, 0}, 4.1));
}

TEST(GpuPoints, AreAsManyAsWereAskedFor) {
    const ChaosGame game = testing::played("a.rifs", fern).game();
    for (const std::uint64_t points : {1ull, 999ull, 128ull * 1024, 300'001ull})
        EXPECT_EQ(points_in(*by_gpu(ChaosSource(game, 1), camera_at({0, 5, 0}, 20), points)), points);
}

/// Sums of 32 bits hold the levels of 4.2 million points, where colours lie on a line.
TEST(GpuPoints, MayAllFallIntoOnePixel) {
    const ChaosGame game =
        testing::played("a.rifs",
                        "rifs p { map a { scale 1/2 tint rgb <1, 0, 0> 1 probability 0.9 }\n"
                        "map b { scale 1/2 translate <1/2, 0, 0> tint rgb <0, 0, 1> 1 probability 0.1 } }")
            .game();
    constexpr std::uint64_t points = (1u << 24) + 1000;
    const auto picture = by_gpu(ChaosSource(game, 1), camera_at({10, 10, 0}, 1000), points);
    const auto fullest = std::ranges::max_element(picture->cells(), {}, &Accumulation::Cell::count);
    ASSERT_EQ(fullest->count, points);
    const Rgb mean = picture->mean_colour(*fullest);
    EXPECT_NEAR(mean.r, 0.9, 0.01);
    EXPECT_NEAR(mean.b, 0.1, 0.01);
}

/// Again, and however sums are added; pixels are small enough for packed ones, and some fill these more than
/// once.
TEST(GpuPoints, AreTheSameEachTime) {
    const ChaosGame game = testing::played("a.rifs", quadrants).game();
    constexpr ImageSize fine{170, 140};
    constexpr std::uint64_t more = 1'500'000;
    const Camera camera = camera_at({0.5, 0.5, 0}, 1.2);
    const auto once = by_gpu(ChaosSource(game, 1), camera, more, GpuPoints::Sums::packed, fine);
    const auto most = std::ranges::max_element(once->cells(), {}, &Accumulation::Cell::count)->count;
    EXPECT_GT(most, 400u);
    EXPECT_LT(most, more / 2048);
    const auto expect_same = [&](const Accumulation& again) {
        for (std::size_t i = 0; i < once->cells().size(); ++i) {
            const Accumulation::Cell &a = once->cells()[i], &b = again.cells()[i];
            ASSERT_TRUE(a.count == b.count && std::ranges::equal(a.rgb, b.rgb)) << i;
        }
    };
    for (const auto sums : {GpuPoints::Sums::packed, GpuPoints::Sums::pairs, GpuPoints::Sums::apart})
        expect_same(*by_gpu(ChaosSource(game, 1), camera, more, sums, fine));
    expect_same(
        *by_gpu(ChaosSource(game, 1), camera, more, GpuPoints::Sums::packed, fine, 100'000)); // in bands
}

/// Devices round a little otherwise, so that some points fall into the next pixel.
TEST(GpuPoints, AreThoseOfTheKernelsText) {
    const ChaosGame game =
        testing::played("a.rifs", "rifs p { map a { scale 1/2 } map b { scale 1/2 translate <1/2, 0> }\n"
                                  "map c { scale 1/2 translate <0, 1/2> } map d { scale 1/2 translate "
                                  "<1/2, 1/2> } follow all except self }")
            .game();
    const ChaosSource source(game, 1);
    const Camera camera = camera_at({0.51, 0.52, 0}, 1.43);
    std::string why;
    const std::optional<FlatGame> flat =
        source.flat(PointProjection(camera, small).picture_from_world(), {}, why);
    ASSERT_TRUE(flat) << why;
    constexpr std::uint32_t points = 50'001;
    const std::vector<std::uint32_t> text = by_text(*flat, points);
    const auto device = by_gpu(source, camera, points);
    double apart = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
        apart += std::abs(static_cast<double>(text[i]) - static_cast<double>(device->cells()[i].count));
    EXPECT_LT(apart, 20);
}

/// The formulas of two maps, as steps of the kernel's text and as the processors compute them.
TEST(GpuPoints, FormulasHaveTheirValues) {
    const char* const formulas[] = {"sin(x)",
                                    "cos(x)",
                                    "tan(x)",
                                    "asin(x/40)",
                                    "acos(y/40)",
                                    "atan(x)",
                                    "atan2(x, y)",
                                    "sqrt(x)",
                                    "exp(x/10)",
                                    "log(y)",
                                    "floor(x)",
                                    "ceil(y)",
                                    "abs(x)",
                                    "sign(x)",
                                    "min(x, y)",
                                    "max(x, y)",
                                    "mod(x, y)",
                                    "pow(x, 3)",
                                    "pow(y, 2)",
                                    "pow(x, 0.5)",
                                    "lerp(x, y, 0.3)",
                                    "choose(x > y, 1/(x - y), y)",
                                    "smooth(-3, 5, x)",
                                    "logistic(x, 3, 0.2, y)",
                                    "x % 3",
                                    "x ^ -1",
                                    "-x + 2*y - x/y",
                                    "!(x < y)",
                                    "x < 0 && sqrt(-x) > 2",
                                    "x < 0 || sqrt(x) > 2",
                                    "(x == y) + (x != y)",
                                    "(x <= 4) + (y >= 4)",
                                    "let",
                                    "7",
                                    "y"};
    int values = 0, none = 0;
    for (const std::string formula : formulas) {
        const std::string map =
            formula == "let" ? "let a = x + y, b = a*a\n x = b - a y = a" : "x = " + formula + " y = 0";
        SourceMap sources;
        Diagnostics diagnostics;
        LowerOptions options;
        options.may_be_orbit = true;
        const auto lowered =
            lower_text("o.rifs", "orbit o {\n map { " + map + " }\n map { x = 0 y = 0 }\n}\n", options,
                       sources, diagnostics);
        ASSERT_TRUE(lowered.notes.orbit) << formula << diagnostics.render(sources);
        const OrbitModel& model = *lowered.notes.orbit;
        std::string why;
        const std::optional<FlatGame> flat = OrbitSource(model, 1).flat(Affine(), {}, why);
        ASSERT_TRUE(flat) << formula << why;
        points_kernel::game = &*flat;
        RandomStream random(1, 1);
        glm::uvec4 unused(1);
        std::vector<double> slots;
        for (int i = 0; i < 100; ++i) {
            const Vec3 place(std::floor(80 * random.unit() - 40) / 4, std::floor(80 * random.unit() - 40) / 4,
                             0);
            const std::optional<Vec3> expected = apply(model.maps[0], place, {}, slots);
            glm::vec3 found = place;
            ASSERT_EQ(points_kernel::compute(0, found, unused), expected.has_value())
                << formula << place.x << "," << place.y;
            ++(expected ? values : none);
            if (!expected) continue;
            EXPECT_NEAR(found.x, expected->x, 2e-5 * (1 + std::abs(expected->x)))
                << formula << " " << place.x << "," << place.y;
        }
    }
    EXPECT_GT(values, 2000);
    EXPECT_GT(none, 100);
}

TEST(GpuPoints, OrbitsThatSkipMuchAreForTheProcessors) {
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.may_be_orbit = true;
    for (const auto& [skip, is_flat] : {std::pair("50000", true), {"50001", false}}) {
        const auto lowered = lower_text("o.rifs",
                                        "orbit o { skip " + std::string(skip) +
                                            "\n map { x = x/2 y = 0 }\n map { x = 0 y = y/2 }\n}\n",
                                        options, sources, diagnostics);
        ASSERT_TRUE(lowered.notes.orbit) << diagnostics.render(sources);
        std::string why;
        EXPECT_EQ(OrbitSource(*lowered.notes.orbit, 1).flat(Affine(), {}, why).has_value(), is_flat) << why;
        EXPECT_EQ(why.find("'skip' leaves out more than 50000 points") == std::string::npos, is_flat) << why;
    }
}

/// One in two moves of each map has no value: see Points.OrbitsMayBeginAgain.
TEST(GpuPoints, OrbitsBeginAgainInTheKernelsText) {
    const std::string map = "map { x = 1/floor(random(0, 2))  y = 0 }\n";
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.may_be_orbit = true;
    const auto lowered =
        lower_text("o.rifs", "orbit o { restart 0.9\n" + map + map + "}", options, sources, diagnostics);
    ASSERT_TRUE(lowered.notes.orbit) << diagnostics.render(sources);
    std::string why;
    const std::optional<FlatGame> flat =
        OrbitSource(*lowered.notes.orbit, 1)
            .flat(PointProjection(camera_at({0, 0, 0}, 3.07), small).picture_from_world(), {}, why);
    ASSERT_TRUE(flat) << why;
    const std::vector<std::uint32_t> cells = by_text(*flat, many);
    const double all = std::accumulate(cells.begin(), cells.end(), 0.0);
    EXPECT_EQ(all, many); // none is lost
    EXPECT_NEAR(*std::ranges::max_element(cells) / all, 31.0 / 32, 0.001);
    EXPECT_GT(std::ranges::count_if(cells, [](std::uint32_t points) { return points > 0; }), 600);
}

TEST(GpuPoints, OrbitsHaveTheMeasureOfTheProcessors) {
    const std::string text =
        "orbit o {\n start <0.1, 0.2>\n"
        "map { let u = random(0, 360) x = x/2 + cos(u)/4 y = y/2 + normal(0, 0.1)\n"
        " tint rgb <1, 0, 0> 1/2 }\n"
        "map { let r = x*x + y*y x = sin(60*x) + y/3 y = r/(1 + r) tint rgb <0, 0, 1> 1/2 }\n"
        "map { x = 1 - abs(y) y = x/2 }\n"
        "follow matrix {\n 1 1 0\n 1 1 2\n 1 1 1\n }\n"
        "final { x = x + y*y y = y tint rgb <0, 1, 0> 0.1 }\n}\n";
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.may_be_orbit = true;
    const auto lowered = lower_text("o.rifs", text, options, sources, diagnostics);
    ASSERT_TRUE(lowered.notes.orbit) << diagnostics.render(sources);
    expect_same_measure(OrbitSource(*lowered.notes.orbit, 1), OrbitSource(*lowered.notes.orbit, 2),
                        camera_at({0.3, 0.4, 0}, 3.07));
}

TEST(GpuPoints, SinglePrecisionHasItsLimit) {
    const ChaosGame game = testing::played("a.rifs", quadrants).game();
    const ChaosSource source(game, 1);
    const auto is_sharp = [&](double width) {
        return is_sharp_in_single(source, PointProjection(camera_at({0.3, 0.3, 0}, width), small));
    };
    EXPECT_TRUE(is_sharp(1));
    EXPECT_TRUE(is_sharp(1e-3));
    EXPECT_FALSE(is_sharp(1e-7));
}

} // namespace
} // namespace graftal
