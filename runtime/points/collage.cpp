#include "runtime/points/collage.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/chaos/chaos_game.h"
#include "compiler/chaos/ordinary_ifs.h"
#include "compiler/graph/refuse_combined.h"
#include "compiler/support/number.h"
#include "runtime/points/target_picture.h"

namespace graftal {

namespace {

constexpr double half_diagonal = 0.70710678118654752; ///< of a cell
constexpr std::uint64_t most_parts = 40'000'000;      ///< of an attractor
constexpr std::uint64_t most_cells = 1u << 27;
constexpr std::uint64_t random_points = 8'000'000; ///< where there is condensation

/// The grid: pixels of the picture, and as many around it as images reach.
class Grid {
  public:
    Grid(const View& view, const std::vector<Instance>& maps, const Ball& attractor)
        : camera_(view.camera), size_(view.size) {
        to_pixels_.linear = Mat3(0.0);
        const double scale = view.size.width / camera_.width;
        for (int axis = 0; axis < 3; ++axis) {
            to_pixels_.linear[axis][0] = scale * camera_.right[axis];
            to_pixels_.linear[axis][1] = -scale * camera_.up[axis];
            to_pixels_.linear[axis][2] = scale * camera_.direction[axis];
        }
        to_pixels_.translation =
            Vec3(0.5 * size_.width, 0.5 * size_.height, 0) - to_pixels_.linear * camera_.location;
        // The depth of the plane becomes 0.
        to_pixels_.translation.z -= to_pixels_(Vec3(0.0)).z;
        pixel_ = 1 / scale;
        reach(maps, attractor);
    }

    double pixel() const { return pixel_; }
    bool fits() const { return fits_; }
    CellSet empty() const { return {width_, height_}; }
    /// A map of the model's plane as one of pixels.
    Affine in_pixels(const Affine& map) const { return to_pixels_ * map * inverse(to_pixels_); }
    Vec3 pixels_of(Vec3 point) const { return to_pixels_(point); }

    CellSet framed(const CellSet& picture) const {
        CellSet set = empty();
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                if (picture.at(x, y)) set.cells[set.index(x + left_, y + above_)] = true;
        return set;
    }

    void mark(CellSet& set, Vec3 p) const {
        const double x = std::floor(p.x) + left_, y = std::floor(p.y) + above_;
        if (x >= 0 && y >= 0 && x < width_ && y < height_)
            set.cells[set.index(static_cast<int>(x), static_cast<int>(y))] = true;
    }

  private:
    /// Makes room for the images of the picture and for the attractor.
    void reach(const std::vector<Instance>& maps, const Ball& attractor) {
        Box box{Vec3(0.0), Vec3(size_.width, size_.height, 0)};
        const Box picture = box;
        for (const Instance& map : maps)
            for (const Vec3& corner : picture.corners())
                box.include(in_pixels(map.parent_from_child)(corner));
        const Vec3 middle = to_pixels_(attractor.centre);
        const double radius = attractor.radius / pixel_;
        box.include(middle - Vec3(radius));
        box.include(middle + Vec3(radius));
        const Vec3 low = glm::floor(box.min) - 1.0, high = glm::ceil(box.max) + 1.0;
        const Vec3 cells = high - low;
        fits_ = cells.x * cells.y <= static_cast<double>(most_cells);
        if (!fits_) return;
        left_ = static_cast<int>(-low.x);
        above_ = static_cast<int>(-low.y);
        width_ = static_cast<int>(cells.x);
        height_ = static_cast<int>(cells.y);
    }

    Camera camera_;
    ImageSize size_;
    Affine to_pixels_;
    double pixel_ = 1;
    bool fits_ = false;
    int left_ = 0, above_ = 0, width_ = 0, height_ = 0;
};

/// The union of the target's images.
CellSet images_of(const CellSet& target, const CellSet& framed, const Grid& grid,
                  const std::vector<Instance>& maps) {
    CellSet images = framed; // its size
    std::fill(images.cells.begin(), images.cells.end(), false);
    for (const Instance& instance : maps) {
        const Affine map = grid.in_pixels(instance.parent_from_child);
        for (int y = 0; y < target.height; ++y)
            for (int x = 0; x < target.width; ++x)
                if (target.at(x, y)) grid.mark(images, map({x + 0.5, y + 0.5, 0}));
    }
    return images;
}

/// The attractor by its parts: each as small as half a cell.
class Attractor {
  public:
    Attractor(const std::vector<Instance>& maps, const Ball& ball, const Grid& grid) : grid_(grid) {
        for (const Instance& map : maps)
            maps_.push_back(grid.in_pixels(map.parent_from_child));
        middle_ = grid.pixels_of(ball.centre);
        radius_ = ball.radius / grid.pixel();
    }

    std::optional<CellSet> cells() {
        CellSet set = grid_.empty();
        std::vector<Affine> stack = {Affine()};
        std::uint64_t left = most_parts;
        while (!stack.empty()) {
            const Affine part = stack.back();
            stack.pop_back();
            if (left-- == 0) return std::nullopt;
            if (flat_norm(part.linear) * radius_ <= 0.25) {
                grid_.mark(set, part(middle_));
                continue;
            }
            for (const Affine& map : maps_)
                stack.push_back(part * map);
        }
        return set;
    }

  private:
    static double flat_norm(const Mat3& m) {
        const double a = m[0][0], b = m[1][0], c = m[0][1], d = m[1][1];
        const double sum = a * a + b * b + c * c + d * d, det = a * d - b * c;
        return std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4 * det * det))));
    }

    const Grid& grid_;
    std::vector<Affine> maps_;
    Vec3 middle_;
    double radius_ = 0;
};

/// Adds the shadows of random points of the graph from `root` on.
void mark_points(const AnalysedModel& model, Graph graph, const Grid& grid, CellSet& set) {
    const double rate = model.contraction.certificate.rate;
    const auto game = ChaosGame::of(graph, strong_components(graph), model.bounds, rate);
    if (!game) return;
    ChaosPlayer player(*game, 0, 0);
    std::vector<ChaosPoint> points(1000);
    for (std::uint64_t done = 0; done < random_points; done += points.size()) {
        player.fill(points);
        for (const ChaosPoint& point : points)
            grid.mark(set, grid.pixels_of(point.place));
    }
}

bool faces_plane(const Camera& camera) {
    return camera.orthographic && std::abs(camera.direction.z) >= 1 - 1e-9;
}

/// The system, if the theorem says something about it.
std::optional<OrdinaryIfs> system_of(const AnalysedModel& model, Diagnostics& diagnostics) {
    const Object& root = model.graph.objects[model.graph.root];
    std::optional<OrdinaryIfs> ifs = ordinary_ifs(model.graph, model.components);
    if (!ifs) {
        diagnostics
            .error(root.span, fmt::format("'{}' is not an iterated function system: {}", root.name,
                                          model.components.unending[model.graph.root]
                                              ? "not every map may follow every map"
                                              : "it does not contain itself"))
            .with_hint("the collage theorem needs one target, and a set that is the union of its own images");
        return std::nullopt;
    }
    for (const Instance& map : ifs->maps)
        if (!is_flat(map.parent_from_child)) {
            diagnostics.error(map.span, "this map leaves the plane z = 0, so a picture cannot be its target");
            return std::nullopt;
        }
    return ifs;
}

std::optional<PlaneNorm> norm_of(const OrdinaryIfs& ifs, Diagnostics& diagnostics) {
    const PlaneNorm norm = contracting_norm(ifs.maps);
    if (norm.rate < 1) return norm;
    diagnostics.error(ifs.maps.front().span,
                      fmt::format("graftal found no norm in which each map contracts; in the plane's own "
                                  "norm, the maps lengthen up to {} times",
                                  shortest(norm.rate)));
    return std::nullopt;
}

Collage measured(const AnalysedModel& model, const OrdinaryIfs& ifs, const PlaneNorm& norm, const Grid& grid,
                 const CellSet& target) {
    Collage collage;
    collage.pixels = target.cells.size();
    collage.target_pixels =
        static_cast<std::size_t>(std::count(target.cells.begin(), target.cells.end(), true));
    collage.pixel = grid.pixel();
    collage.maps = ifs.maps.size();
    collage.condensations = ifs.condensation.size();
    collage.euclidean = norm.metric == Mat3(1.0);
    collage.condition = norm.condition;
    collage.contractivity = norm.rate;

    const CellSet framed = grid.framed(target);
    CellSet images = images_of(target, framed, grid, ifs.maps);
    if (!ifs.condensation.empty()) {
        Graph parts = model.graph;
        parts.objects[parts.root].instances = ifs.condensation;
        mark_points(model, std::move(parts), grid, images);
    }
    const double epsilon = hausdorff_distance(framed, images);
    collage.epsilon = epsilon * collage.pixel;
    collage.bound = norm.condition * (epsilon + half_diagonal) * collage.pixel / (1 - norm.rate);

    std::optional<CellSet> attractor = grid.empty();
    if (ifs.condensation.empty())
        attractor = Attractor(ifs.maps, model.bounds[model.graph.root].ball, grid).cells();
    else
        mark_points(model, model.graph, grid, *attractor);
    if (attractor) collage.distance = hausdorff_distance(framed, *attractor) * collage.pixel;
    return collage;
}

} // namespace

std::optional<Collage> measure_collage(Session& session, const CollageOptions& options,
                                       Compilation& compilation) {
    TargetPicture target;
    compilation.status = read_target(options.target, options.criterion, target);
    if (!compilation.status.ok()) return std::nullopt;
    StageOptions compile = options.compile;
    compile.view.size = {target.width, target.height};
    compile.view.shaped = false;
    const std::shared_ptr<const ViewedModel> viewed = session.viewed(compile, compilation);
    if (!viewed) return std::nullopt;
    Diagnostics& diagnostics = compilation.diagnostics;
    const AnalysedModel& model = *viewed->model;
    if (refuse_combined(model.graph, "a collage", diagnostics)) return std::nullopt;
    const std::optional<OrdinaryIfs> ifs = system_of(model, diagnostics);
    const std::optional<PlaneNorm> norm = ifs ? norm_of(*ifs, diagnostics) : std::nullopt;
    if (!norm) return std::nullopt;
    const Span root = model.graph.objects[model.graph.root].span;
    if (!faces_plane(viewed->view.camera)) {
        diagnostics.error(root, "the camera must look straight at the plane z = 0, by parallel rays")
            .with_hint("try --camera \"orthographic\", or a camera statement without a location");
        return std::nullopt;
    }
    if (target.empty()) {
        diagnostics.error({}, empty_target_text(options.target, options.criterion, target.by_alpha));
        return std::nullopt;
    }
    const Grid grid(viewed->view, ifs->maps, model.bounds[model.graph.root].ball);
    if (!grid.fits()) {
        diagnostics.error(root, "the model reaches too far beyond the picture for a comparison");
        return std::nullopt;
    }
    Collage collage = measured(model, *ifs, *norm, grid, target.cells);
    collage.by_alpha = target.by_alpha;
    return collage;
}

} // namespace graftal
