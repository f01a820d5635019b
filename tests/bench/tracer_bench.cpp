// Camera rays a second, on one thread: by the traversal of the graph, and by Embree on the same parts spelt
// out as one mesh; and rays that leave the surfaces that those meet. See tools/bench/tracer.
//   tracer_bench graph MODEL STEPS ERROR_PX       STEPS: a number, or - for as deep as the error asks
//   tracer_bench light MODEL STEPS ERROR_PX
//   tracer_bench compare MODEL STEPS

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "compiler/support/counter_random.h"
#include "runtime/system/disk_files.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/bench/embree_rays.h"

namespace graftal {
namespace {

constexpr ImageSize size{640, 480};
constexpr int repeats = 5;

/// Seconds of processor: rays are traced on one thread, and other work must not count.
double now() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double peak_mib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmHWM:", 0) == 0) return std::strtod(line.c_str() + 6, nullptr) / 1024;
    return 0;
}

std::unique_ptr<TraceModel> load(const std::string& path, const std::string& steps, double error_px) {
    StageOptions options;
    options.view.size = size;
    options.detail.error_px = error_px;
    if (steps != "-") options.lower.steps = static_cast<unsigned>(std::stoul(steps));
    Compilation compilation;
    Session session(path, disk_files());
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    if (!prepared) {
        std::fputs(compilation.diagnostics.render(compilation.sources).c_str(), stderr);
        std::exit(1);
    }
    return std::make_unique<TraceModel>(prepared, viewed->view, resolved(options.detail, *viewed));
}

std::vector<Ray> camera_rays(const View& view) {
    const CameraRays through(view);
    std::vector<Ray> rays;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            rays.push_back(through.through(x + 0.5, y + 0.5));
    return rays;
}

/// Prints the best of some runs; `trace` counts hits.
template<typename Trace> void measure(const std::vector<Ray>& rays, const Trace& trace) {
    double best = 1e300;
    std::size_t hits = 0;
    for (int i = 0; i < repeats; ++i) {
        const double start = now();
        hits = trace();
        best = std::min(best, now() - start);
    }
    std::printf(" %.3f Mrays/s, %zu hits, peak %.1f MiB\n", 1e-6 * static_cast<double>(rays.size()) / best,
                hits, peak_mib());
}

/// Calls `visit` with packets of 4x2 neighbours, as pictures are made.
template<typename Visit> void for_each_packet(const std::vector<Ray>& rays, const Visit& visit) {
    constexpr std::size_t width = size.width, height = size.height, across = 4, down = 2;
    std::array<Ray, across * down> packet;
    for (std::size_t y = 0; y < height; y += down)
        for (std::size_t x = 0; x < width; x += across) {
            for (std::size_t i = 0; i < packet.size(); ++i)
                packet[i] = rays[(y + i / across) * width + x + i % across];
            visit(packet);
        }
}

std::size_t hits_together(Traversal& traversal, const std::vector<Ray>& rays) {
    std::array<SurfaceHit, Surfaces::most_together> seen;
    std::size_t hits = 0;
    for_each_packet(rays, [&](std::span<const Ray> packet) {
        hits += static_cast<std::size_t>(std::popcount(traversal.closest_each(packet, {}, seen)));
    });
    return hits;
}

void graph(const TraceModel& model) {
    const std::vector<Ray> rays = camera_rays(model.view);
    Traversal traversal(model), together(model);
    measure(rays, [&] { return hits_together(together, rays); });
    std::printf("one by one:");
    measure(rays, [&] {
        std::size_t hits = 0;
        SurfaceHit hit;
        for (const Ray& ray : rays)
            hits += traversal.closest(ray, {}, hit);
        return hits;
    });
    std::printf("visits a ray: %.2f\n",
                static_cast<double>(traversal.visits()) / (repeats * static_cast<double>(rays.size())));
}

/// One ray from each point that the camera sees, by the cosine, as a sky's light comes.
std::vector<Ray> scattered_rays(const TraceModel& model) {
    Traversal traversal(model);
    std::vector<Ray> rays;
    const CounterRandom random(0);
    std::uint64_t number = 0;
    for (const Ray& ray : camera_rays(model.view)) {
        SurfaceHit hit;
        if (!traversal.closest(ray, {}, hit)) continue;
        const Vec3 normal = glm::dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal;
        const double height = 2 * CounterRandom::unit(random(++number)) - 1;
        const double turn = 2 * std::numbers::pi * CounterRandom::unit(random(++number));
        const double radius = std::sqrt(1 - height * height);
        const Vec3 on_sphere(radius * std::cos(turn), radius * std::sin(turn), height);
        rays.push_back({ray(hit.t), glm::normalize(normal + on_sphere)});
    }
    return rays;
}

/// Where they begin, so that they do not meet the surface that they leave.
double least_distance(const TraceModel& model) {
    return 1e-5 * glm::length(model.prepared.bounds.size());
}

void light(const TraceModel& model) {
    const std::vector<Ray> rays = scattered_rays(model);
    const double least = least_distance(model);
    Traversal traversal(model);
    std::printf("closest:");
    measure(rays, [&] {
        std::size_t hits = 0;
        SurfaceHit hit;
        for (const Ray& ray : rays)
            hits += traversal.closest(ray, {least}, hit);
        return hits;
    });
    const std::uint64_t before = traversal.visits();
    std::printf("any:");
    measure(rays, [&] {
        std::size_t hits = 0;
        for (const Ray& ray : rays)
            hits += traversal.meets_any(ray, {least});
        return hits;
    });
    const std::uint64_t after = traversal.visits();
    const double all = repeats * static_cast<double>(rays.size());
    std::printf("visits a ray: %.2f, any %.2f\n", static_cast<double>(before) / all,
                static_cast<double>(after - before) / all);
}

/// Rays of both kinds by Embree, in all its ways, and by the traversal, one after the other in each of some
/// rounds; prints the best of each.
void compare(const TraceModel& model) {
    const std::vector<Ray> camera = camera_rays(model.view), scattered = scattered_rays(model);
    const double least = least_distance(model);
    const EmbreeScene mesh(model, EmbreeScene::Form::mesh), placed(model, EmbreeScene::Form::instances);
    Traversal traversal(model);
    const auto traced = [&](const std::vector<Ray>& rays, double from) {
        std::size_t hits = 0;
        SurfaceHit hit;
        for (const Ray& ray : rays)
            hits += traversal.closest(ray, {from}, hit);
        return hits;
    };
    struct Contest {
        const char* name;
        const std::vector<Ray>& rays;
        std::function<std::size_t()> trace;
        double best = 1e300;
        std::size_t hits = 0;
    };
    constexpr auto width = static_cast<std::size_t>(size.width);
    std::vector<Contest> contests = {
        {"mesh", camera, [&] { return mesh.hits(camera, 0, true); }},
        {"mesh_bounce", scattered, [&] { return mesh.hits(scattered, least, false); }},
        {"by_8", camera, [&] { return mesh.hits_by_8(camera, width); }},
        {"by_16", camera, [&] { return mesh.hits_by_16(camera, width); }},
        {"instances", camera, [&] { return placed.hits(camera, 0, true); }},
        {"instances_bounce", scattered, [&] { return placed.hits(scattered, least, false); }},
        {"graph", camera, [&] { return hits_together(traversal, camera); }},
        {"graph_singly", camera, [&] { return traced(camera, 0); }},
        {"graph_bounce", scattered, [&] { return traced(scattered, least); }},
    };
    for (int round = 0; round < repeats; ++round)
        for (Contest& contest : contests) {
            const double start = now();
            contest.hits = contest.trace();
            contest.best = std::min(contest.best, now() - start);
        }
    std::printf("triangles %zu\nbuild %.2f\nmesh_mib %.0f\ninstances_mib %.1f\n", mesh.triangles(),
                mesh.build_seconds(), mesh.mib(), placed.mib());
    for (const Contest& contest : contests)
        std::printf("%s %.2f %zu\n", contest.name,
                    1e-6 * static_cast<double>(contest.rays.size()) / contest.best, contest.hits);
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    const std::string mode = argc > 3 ? argv[1] : "";
    if (mode == "graph" && argc == 5) {
        graftal::graph(*graftal::load(argv[2], argv[3], std::strtod(argv[4], nullptr)));
    } else if (mode == "light" && argc == 5) {
        graftal::light(*graftal::load(argv[2], argv[3], std::strtod(argv[4], nullptr)));
    } else if (mode == "compare" && argc == 4) {
        graftal::compare(*graftal::load(argv[2], argv[3], 0));
    } else {
        std::fputs("usage: tracer_bench graph|light MODEL STEPS ERROR_PX | compare MODEL STEPS\n", stderr);
        return 2;
    }
}
