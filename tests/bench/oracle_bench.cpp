// oracle_bench MODEL WxH MEMORY_MIB [FOLDER]: draws a model in three views by POV-Ray and natively, and
// prints for each a line of fields, separated by tabs, that tools/bench/oracle makes its table of. Pictures
// go to the folder, if there is one.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "runtime/image_files/image_files.h"
#include "runtime/system/disk_files.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/image/oracle.h"

namespace graftal {
namespace {

struct Request {
    std::string path;
    ImageSize size{480, 360};
    OracleOptions options;
    std::string folder;
};

/// What the views of a model are chosen by.
struct Model {
    Box box;
    double size = 1; ///< half the box's diagonal
    bool flat = false;
    Camera camera; ///< of its own view
    std::optional<double> ground;
    Vec3 point{0.0}; ///< on a surface, somewhere in the middle of its own view
};

/// A point of the model in the middle of its pixels that are hit, in reading order.
Vec3 some_point(const DetailedModel& ours, Vec3 otherwise) {
    const AnalysedModel& analysed = *ours.viewed->model;
    const View& view = ours.viewed->view;
    const TraceModel model(
        std::make_shared<const PreparedGraph>(
            prepare_graph(analysed.graph, analysed.components, analysed.bounds, ours.detail.preparing())),
        view, ours.detail);
    Traversal traversal(model);
    const CameraRays rays(view);
    std::vector<Vec3> points;
    constexpr int stride = 4;
    for (int y = 0; y < view.size.height; y += stride)
        for (int x = 0; x < view.size.width; x += stride) {
            const Ray ray = rays.through(x, y);
            SurfaceHit hit;
            if (traversal.closest(ray, {}, hit)) points.push_back(ray(hit.t));
        }
    constexpr double share = 0.4;
    return points.empty() ? otherwise
                          : points[static_cast<std::size_t>(share * static_cast<double>(points.size()))];
}

Model model_of(const DetailedModel& ours) {
    const ViewedModel& viewed = *ours.viewed;
    Model model;
    model.box = viewed.model->bounds[viewed.model->graph.root].box;
    const Vec3 centre = model.box.empty() ? Vec3(0.0) : model.box.centre();
    const Vec3 sides = model.box.empty() ? Vec3(2.0) : model.box.size();
    model.size = 0.5 * glm::length(sides);
    model.flat = std::min({sides.x, sides.y, sides.z}) < 1e-6 * model.size;
    model.camera = viewed.view.camera;
    if (viewed.view.ground) model.ground = viewed.view.ground->height;
    model.point = some_point(ours, centre);
    return model;
}

/// A window on a flat figure, tilted, so that no row of pixels runs along its edges.
CameraSetting window(const Model& model, Vec3 at, double share) {
    const Camera& own = model.camera;
    CameraSetting camera;
    camera.orthographic = true;
    camera.look_at = at;
    camera.location = at - 2 * model.size * own.direction;
    camera.up = own.up + 0.317 * own.right;
    camera.width = share * model.size;
    return camera;
}

Vec3 turned(Vec3 direction, double degrees) {
    return Affine::rotate({0, 1, 0}, degrees)(direction);
}

CameraSetting from_the_side(const Model& model, bool parallel) {
    const Vec3 centre = model.box.empty() ? model.point : model.box.centre();
    if (model.flat)
        return window(model, centre + 0.113 * model.size * (model.camera.right - model.camera.up), 0.613);
    CameraSetting camera;
    const Vec3 towards = glm::normalize(turned({0.231, 0.417, 1}, 71.3));
    camera.look_at = centre;
    camera.location = centre + 3.3 * model.size * towards;
    if (model.ground) camera.location->y = std::max(camera.location->y, *model.ground + 0.3 * model.size);
    camera.orthographic = parallel;
    if (parallel)
        camera.width = 2.3 * model.size;
    else
        camera.angle_deg = 41;
    return camera;
}

CameraSetting close_up(const Model& model) {
    if (model.flat) return window(model, model.point, 0.0717);
    CameraSetting camera;
    const Vec3 back = turned(-model.camera.direction, 36.7) + Vec3(0, 0.1, 0);
    camera.look_at = model.point;
    camera.location = model.point + 0.35 * model.size * glm::normalize(back);
    if (model.ground) camera.location->y = std::max(camera.location->y, *model.ground + 0.05 * model.size);
    camera.angle_deg = 47;
    return camera;
}

Image difference_of(const Image& a, const Image& b) {
    Image image = a;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = std::min(1.0f, 8 * std::abs(srgb_encoded(a.pixels[i]) - srgb_encoded(b.pixels[i])));
    return image;
}

void keep(const OracleReport& report, const std::string& stem) {
    const auto encoded = [](Image image) {
        for (float& sample : image.pixels)
            sample = srgb_encoded(sample);
        return image;
    };
    (void)write_image(stem + "_povray.png", encoded(report.povray.lit), SampleFormat::srgb8);
    (void)write_image(stem + "_native.png", encoded(report.native.lit), SampleFormat::srgb8);
    (void)write_image(stem + "_difference.png", difference_of(report.povray.lit, report.native.lit),
                      SampleFormat::srgb8);
}

std::string error_of(const OracleReport& report) {
    return report.error_world > 0 ? fmt::format("{:.2g} units", report.error_world)
                                  : fmt::format("{:.3g} px", report.error_px);
}

void print(const Request& request, const std::string& view, const OracleReport& r) {
    const auto three = [](const Disagreement& d) {
        return fmt::format("{}\t{}\t{}", d.pixels, d.away, d.untied - d.coinciding);
    };
    fmt::print("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:.2f}\n", request.path, view,
               r.triangles ? "meshes" : "parts", error_of(r), r.placements, r.pixels, r.hits, three(r.mask),
               three(r.depth), three(r.colour), r.colour.coinciding, r.horizon, r.mean, r.max);
    std::fflush(stdout);
    fmt::print(stderr, "{} {}: {}\n", request.path, view, summary(r));
}

void ask(const Request& request, const std::string& view, const CameraSetting& camera,
         const OracleOptions& options) {
    StageOptions compile;
    compile.view.size = request.size;
    compile.view.camera = camera;
    Compilation compilation;
    const std::optional<OracleReport> report = ask_oracle(request.path, compile, options, compilation);
    if (!report) {
        fmt::print("{}\t{}\tfailed: {}{}\n", request.path, view, compilation.status.message(),
                   compilation.diagnostics.all().empty() ? "" : compilation.diagnostics.all().back().message);
        return;
    }
    print(request, view, *report);
    if (request.folder.empty()) return;
    std::string stem = std::filesystem::path(request.path).lexically_relative("scenes").replace_extension();
    std::replace(stem.begin(), stem.end(), '/', '_');
    keep(*report, request.folder + "/" + stem + "_" + view + (options.flatten ? "" : "_cut"));
}

bool cut_into_meshes(const std::string& path, const StageOptions& options) {
    Compilation ignored;
    Session session(path, disk_files());
    const auto compiled = compile_scene(session, options, ignored);
    return compiled && compiled->cut.triangle_count > 0;
}

int run(const Request& request) {
    StageOptions compile;
    compile.view.size = request.size;
    Compilation compilation;
    const DetailedModel ours = look_at_file(request.path, compile, compilation);
    if (!ours.viewed) {
        fmt::print(stderr, "{}{}", compilation.diagnostics.render(compilation.sources),
                   compilation.status.message());
        return 1;
    }
    const Model model = model_of(ours);
    const bool parallel = request.path.size() % 2 == 0; // one or the other, by nothing in particular
    ask(request, "own", {}, request.options);
    ask(request, parallel ? "side-parallel" : "side", from_the_side(model, parallel), request.options);
    ask(request, "close", close_up(model), request.options);
    if (cut_into_meshes(request.path, compile)) {
        OracleOptions meshes = request.options;
        meshes.flatten = false;
        ask(request, "own", {}, meshes);
    }
    return 0;
}

} // namespace
} // namespace graftal

int main(int count, char** arguments) {
    using namespace graftal;
    Request request;
    int memory = 0;
    if (count < 4 || std::sscanf(arguments[2], "%dx%d", &request.size.width, &request.size.height) != 2 ||
        std::sscanf(arguments[3], "%d", &memory) != 1) {
        fmt::print(stderr, "usage: oracle_bench MODEL WxH MEMORY_MIB [FOLDER]\n");
        return 2;
    }
    request.path = arguments[1];
    request.options.memory_bytes = static_cast<std::uint64_t>(memory) << 20;
    if (count > 4) request.folder = arguments[4];
    return run(request);
}
