// fit_bench KIND FIRST COUNT SECONDS: draws random systems of maps at 256 pixels, lets the search find them
// again from their pictures alone, and prints a line of fields, separated by tabs, for each: name, maps,
// cells, maps found, IoU within a pixel, IoU, Chamfer distance, largest stretch, processor seconds. KIND is
// connected, dusty or classical; or one of these after "space_": then the targets are clouds of 400,000
// random points of systems in space.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "runtime/inverse/found/voxel_target.h"
#include "runtime/inverse/search.h"

namespace graftal {
namespace {

constexpr int picture_size = 256;

template<typename Map> struct CaseOf {
    std::string name;
    std::vector<Map> maps;
    bool similar = false; ///< so much is known
};
using Case = CaseOf<PlaneMap>;
using SpaceCase = CaseOf<SpaceMap>;

/// Moves the attractor into the square of nine tenths of the picture; false where it has no size.
bool fill_picture(PlaneMaps& maps, Draws& draws) {
    Vec2 p(0.0), low(1e9), high(-1e9);
    for (int i = 0; i < 8000; ++i) {
        p = maps[draws.below(maps.size())](p);
        if (i < 200) continue;
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double size = std::max(high.x - low.x, high.y - low.y);
    if (!(size > 1e-6 && size < 1e6)) return false;
    const double scale = 0.9 * picture_size / size;
    const Vec2 middle = 0.5 * (low + high), centre(0.5 * picture_size);
    for (PlaneMap& map : maps) {
        const Vec2 image = centre + scale * (map(middle) - middle), shift = image - map(centre);
        map.e += shift.x;
        map.f += shift.y;
    }
    return true;
}

/// The whole picture: a grid to draw on.
CellSet whole_picture() {
    CellSet set(picture_size, picture_size);
    set.cells.assign(set.cells.size(), true);
    return set;
}

/// The attractor's cells, in the box around them.
CellSet drawn(const PlaneMaps& maps) {
    static const Target grid(whole_picture());
    static AttractorPainter painter(grid);
    PlaneMaps moved = maps;
    for (PlaneMap& map : moved) {
        const Vec2 room(grid.room()), image = map(Vec2(0.0)) + room,
                                      shift = image - (map(room) - map(Vec2(0.0)));
        map.e = shift.x;
        map.f = shift.y;
    }
    painter.draw(moved);
    CellSet set(grid.width(), grid.height());
    for (const std::uint32_t cell : painter.cells())
        set.cells[cell] = true;
    int left = set.width, top = set.height, right = 0, bottom = 0;
    for (int y = 0; y < set.height; ++y)
        for (int x = 0; x < set.width; ++x) {
            if (!set.at(x, y)) continue;
            left = std::min(left, x), right = std::max(right, x + 1);
            top = std::min(top, y), bottom = std::max(bottom, y + 1);
        }
    CellSet crop(right - left, bottom - top);
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            crop.cells[crop.index(x - left, y - top)] = set.at(x, y);
    return crop;
}

/// The share of the set's cells in its largest part, whose cells are at most one apart.
double largest_part(const CellSet& set) {
    std::vector<bool> seen(set.cells.size());
    std::size_t largest = 0, all = 0;
    std::vector<std::array<int, 3>> stack;
    const auto visit = [&](int x, int y, int z) {
        if (!set.at(x, y, z) || seen[set.index(x, y, z)]) return;
        seen[set.index(x, y, z)] = true;
        stack.push_back({x, y, z});
    };
    for (int z = 0; z < set.depth; ++z)
        for (int y = 0; y < set.height; ++y)
            for (int x = 0; x < set.width; ++x) {
                visit(x, y, z);
                std::size_t size = 0;
                for (; !stack.empty(); ++size) {
                    const auto [column, row, layer] = stack.back();
                    stack.pop_back();
                    for (int w = std::max(0, layer - 2); w <= std::min(set.depth - 1, layer + 2); ++w)
                        for (int v = std::max(0, row - 2); v <= std::min(set.height - 1, row + 2); ++v)
                            for (int u = std::max(0, column - 2); u <= std::min(set.width - 1, column + 2);
                                 ++u)
                                visit(u, v, w);
                }
                all += size;
                largest = std::max(largest, size);
            }
    return static_cast<double>(largest) / static_cast<double>(all);
}

/// Two to six maps whose images have this share of the area in all; nothing where one is too long or too
/// thin.
std::optional<PlaneMaps> random_maps(Draws& draws, double area) {
    std::vector<PlaneStretch> stretches(2 + draws.below(5));
    double sum = 0;
    for (PlaneStretch& stretch : stretches) {
        stretch.largest = std::exp(draws.between(std::log(0.2), std::log(0.85)));
        stretch.least = stretch.largest * std::exp(-0.35 * std::abs(draws.normal()));
        sum += stretch.largest * stretch.least;
    }
    PlaneMaps maps;
    for (PlaneStretch& stretch : stretches) {
        stretch.largest *= std::sqrt(area / sum);
        stretch.least *= std::sqrt(area / sum);
        if (stretch.largest > 0.88 || stretch.least < 0.06) return std::nullopt;
        if (draws.unit() < 0.35) stretch.least = -stretch.least;
        stretch.left_rad = draws.between(-std::numbers::pi, std::numbers::pi);
        stretch.right_rad = draws.between(-std::numbers::pi, std::numbers::pi);
        const Vec2 fixed(draws.unit(), draws.unit());
        maps.push_back(map_of(stretch, fixed, fixed));
    }
    return maps;
}

Case random_case(std::uint64_t number, bool dusty) {
    Draws draws(CounterRandom(dusty ? 20'261 : 20'262), number);
    for (;;) {
        std::optional<PlaneMaps> maps =
            random_maps(draws, dusty ? draws.between(0.12, 0.5) : draws.between(0.6, 1.3));
        if (!maps || !fill_picture(*maps, draws)) continue;
        const CellSet set = drawn(*maps);
        const auto cells = std::count(set.cells.begin(), set.cells.end(), true);
        if (cells < 900 || cells > 36'000 || set.width > picture_size || set.height > picture_size) continue;
        const double part = largest_part(set);
        if (dusty ? part <= 0.6 : part >= 0.85) return {"random " + std::to_string(number), std::move(*maps)};
    }
}

std::vector<Case> classical() {
    const double h = std::sqrt(3.0) / 6, third = 1.0 / 3;
    std::vector<Case> cases = {
        {"fern",
         {{0, 0, 0, .16, 0, 0},
          {.85, .04, -.04, .85, 0, 1.6},
          {.2, -.26, .23, .22, 0, 1.6},
          {-.15, .28, .26, .24, 0, .44}}},
        {"dragon", {{.5, -.5, .5, .5, 0, 0}, {-.5, -.5, .5, -.5, 1, 0}}},
        {"Koch curve",
         {{third, 0, 0, third, 0, 0},
          {third / 2, -h, h, third / 2, third, 0},
          {third / 2, h, -h, third / 2, .5, h},
          {third, 0, 0, third, 2 * third, 0}}},
        {"gasket", {{.5, 0, 0, .5, 0, 0}, {.5, 0, 0, .5, .5, 0}, {.5, 0, 0, .5, .25, .433}}},
        {"maple leaf",
         {{.14, .01, 0, .51, -.08, -1.31},
          {.43, .52, -.45, .5, 1.49, -.75},
          {.45, -.49, .47, .47, -1.62, -.74},
          {.49, 0, 0, .51, .02, 1.62}}},
        {"tree",
         {{0, 0, 0, .5, 0, 0},
          {.42, -.42, .42, .42, 0, .2},
          {.42, .42, -.42, .42, 0, .2},
          {.1, 0, 0, .1, 0, .2}}}};
    Draws draws(CounterRandom(1), 0);
    for (Case& known : cases)
        fill_picture(known.maps, draws);
    return cases;
}

/// The cells of random points of the attractor; nothing where they are too few. Large images get more points.
std::optional<VoxelTarget> cloud_of(const SpaceMaps& maps, Draws& draws) {
    std::vector<double> until;
    for (const SpaceMap& map : maps)
        until.push_back((until.empty() ? 0 : until.back()) +
                        std::max(0.02, std::pow(std::abs(map.determinant()), 2.0 / 3)));
    MeshData data;
    Vec3 p = fixed_point(maps.front());
    for (int i = 0; i < 400'000; ++i) {
        const auto chosen = std::upper_bound(until.begin(), until.end() - 1, until.back() * draws.unit());
        data.vertices.push_back(p = maps[static_cast<std::size_t>(chosen - until.begin())](p));
    }
    std::string fault;
    return voxels_of(data, fault);
}

/// Two to four maps whose images have this share of a surface in all; nothing where one is too long or too
/// thin.
std::optional<SpaceMaps> random_space_maps(Draws& draws, double area) {
    SpaceMaps maps(2 + draws.below(3));
    double sum = 0;
    for (SpaceMap& map : maps) {
        Mat3 turns[2];
        for (Mat3& turn : turns) {
            for (int k = 0; k < 9; ++k)
                turn[k / 3][k % 3] = draws.normal();
            turn = nearest_similarity({{turn, Vec3(0.0)}}, Vec3(0.0)).linear;
            turn /= norm(turn);
        }
        const double size = std::exp(draws.between(std::log(0.3), std::log(0.85)));
        const Vec3 factors(size, size * std::exp(-0.3 * std::abs(draws.normal())),
                           size * std::exp(-0.3 * std::abs(draws.normal())));
        map.linear = turns[0] * Affine::scale(factors).linear * turns[1];
        sum += std::pow(std::abs(map.determinant()), 2.0 / 3);
    }
    for (SpaceMap& map : maps) {
        map.linear *= std::sqrt(area / sum);
        const Vec3 stretches = singular_values(map.linear);
        if (stretches.x > 0.88 || stretches.z < 0.06) return std::nullopt;
        const Vec3 fixed(draws.unit(), draws.unit(), draws.unit());
        map = map.taking(fixed, fixed);
    }
    return maps;
}

SpaceCase random_space_case(std::uint64_t number, bool dusty) {
    Draws draws(CounterRandom(dusty ? 20'263 : 20'264), number);
    for (;;) {
        const std::optional<SpaceMaps> maps =
            random_space_maps(draws, dusty ? draws.between(0.15, 0.6) : draws.between(0.8, 1.6));
        const std::optional<VoxelTarget> cloud = maps ? cloud_of(*maps, draws) : std::nullopt;
        if (!cloud || cloud->set < 400) continue;
        const double part = largest_part(cloud->cells);
        if (dusty ? part <= 0.6 : part >= 0.85) return {"random " + std::to_string(number), *maps};
    }
}

SpaceMap cube_copy(double factor, Vec3 fixed) {
    return SpaceMap{{Mat3(factor), Vec3(0.0)}}.taking(fixed, fixed);
}

std::vector<SpaceCase> classical_in_space() {
    SpaceCase tetrahedron{"Sierpinski tetrahedron", {}, false}, octahedron{"octahedron", {}, false},
        dust{"Cantor dust", {}, false}, sponge{"Menger sponge", {}, true};
    for (const Vec3 corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
        tetrahedron.maps.push_back(cube_copy(0.5, corner));
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1, 1}) {
            Vec3 corner(0.0);
            corner[axis] = side;
            octahedron.maps.push_back(cube_copy(0.5, corner));
        }
    for (const double x : {-1, 0, 1})
        for (const double y : {-1, 0, 1})
            for (const double z : {-1, 0, 1}) {
                const int middles = (x == 0) + (y == 0) + (z == 0);
                if (middles == 0) dust.maps.push_back(cube_copy(1.0 / 3, {x, y, z}));
                if (middles <= 1) sponge.maps.push_back(cube_copy(1.0 / 3, {x, y, z}));
            }
    const auto map = [](Vec3 x, Vec3 y, Vec3 z, Vec3 shift) { // the images of the axes
        return SpaceMap{{Mat3(x, y, z), shift}};
    };
    const SpaceCase fern{"fern",
                         {map({0, 0, 0}, {0, .18, 0}, {0, 0, 0}, {0, 0, 0}),
                          map({.85, 0, 0}, {0, .85, -.1}, {0, .1, .85}, {0, 1.6, 0}),
                          map({.2, .2, 0}, {-.2, .2, 0}, {0, 0, .3}, {0, .8, 0}),
                          map({-.2, .2, 0}, {.2, .2, 0}, {0, 0, .3}, {0, .8, 0})},
                         false};
    SpaceCase tree{"tree", {map({.02, 0, 0}, {0, .45, 0}, {0, 0, .02}, {0, 0, 0})}, false};
    for (const double turn : {0.0, 120.0, 240.0}) {
        SpaceMap branch{{Mat3(0.6), {0, 0.45, 0}}};
        branch.linear =
            Affine::rotate({0, 1, 0}, turn).linear * Affine::rotate({1, 0, 0}, 40).linear * branch.linear;
        tree.maps.push_back(branch);
    }
    return {tetrahedron, octahedron, dust, fern, tree, sponge};
}

template<typename Map> void study(const CaseOf<Map>& known, const CellSet& set, double seconds) {
    const TargetOf<Map> target(set);
    SearchOptionsOf<Map> options;
    options.seconds = seconds;
    options.rules.similar = known.similar;
    options.most_maps = std::max(options.most_maps, known.maps.size());
    const std::clock_t begun = std::clock();
    const FoundSystemOf<Map> found = search(target, options, SerialWorkers(), {}, {});
    const double taken = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    AttractorPainterOf<Map> painter(target);
    painter.draw(found.maps);
    const SetAgreement agreement = painter.agreement_in_full();
    std::printf("%s\t%zu\t%zu\t%zu\t%.3f\t%.3f\t%.3f\t%.2f\t%.1f\n", known.name.c_str(), known.maps.size(),
                target.points().size(), found.maps.size(), agreement.tolerant, agreement.strict,
                agreement.chamfer, largest_stretch(found.maps), taken);
    std::fflush(stdout);
}

void study_plane(const std::string& kind, std::uint64_t number, double seconds) {
    const std::vector<Case> cases = classical();
    if (kind == "classical" && number >= cases.size()) return;
    const Case known = kind == "classical" ? cases[number] : random_case(number, kind == "dusty");
    study(known, drawn(known.maps), seconds);
}

void study_space(const std::string& kind, std::uint64_t number, double seconds) {
    const std::vector<SpaceCase> cases = classical_in_space();
    if (kind == "classical" && number >= cases.size()) return;
    const SpaceCase known = kind == "classical" ? cases[number] : random_space_case(number, kind == "dusty");
    Draws draws(CounterRandom(1), number);
    if (const auto cloud = cloud_of(known.maps, draws)) study(known, cloud->cells, seconds);
}

int run(int argc, char** argv) {
    if (argc != 5) return std::fprintf(stderr, "fit_bench KIND FIRST COUNT SECONDS\n"), 2;
    const std::string kind = argv[1];
    const auto first = static_cast<std::uint64_t>(std::atoi(argv[2])),
               count = static_cast<std::uint64_t>(std::atoi(argv[3]));
    const double seconds = std::atof(argv[4]);
    const std::string space = "space_";
    for (std::uint64_t i = first; i < first + count; ++i)
        if (kind.starts_with(space))
            study_space(kind.substr(space.size()), i, seconds);
        else
            study_plane(kind, i, seconds);
    return 0;
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    return graftal::run(argc, argv);
}
