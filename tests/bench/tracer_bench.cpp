// Camera rays a second, on one thread: by the traversal of the graph, and by Embree on the same parts spelt
// out as one mesh; and rays that leave the surfaces that those meet. See tools/bench/tracer.
//   tracer_bench graph MODEL STEPS ERROR_PX       STEPS: a number, or - for as deep as the error asks
//   tracer_bench light MODEL STEPS ERROR_PX
//   tracer_bench mesh|mesh_light MODEL STEPS

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "compiler/detail/piece.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "compiler/support/counter_random.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traversal.h"

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
    Session session(path);
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

void graph(const TraceModel& model) {
    const std::vector<Ray> rays = camera_rays(model.view);
    Traversal traversal(model);
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
    const double all = repeats * static_cast<double>(rays.size());
    std::printf("visits a ray: %.2f, any %.2f\n", static_cast<double>(before) / all,
                static_cast<double>(traversal.visits() - before) / all);
}

/// All leaves as triangles; curved ones as coarsely as can be.
struct Flat {
    std::vector<float> vertices;
    std::vector<unsigned> corners;
};

Flat flatten(const TraceModel& model) {
    const CutGraph& cut = model.prepared.cut;
    Flat flat;
    Piece root;
    root.node = cut.root;
    root.steps = model.prepared.root_steps;
    std::vector<Piece> stack = {root};
    const auto add = [&](const Primitive& kind, const Affine& place) {
        const TessellatedPrimitive& mesh = tessellated(kind, 0);
        const auto first = static_cast<unsigned>(flat.vertices.size() / 3);
        for (const Vec3& vertex : mesh.vertices)
            for (int i = 0; i < 3; ++i)
                flat.vertices.push_back(static_cast<float>(place(vertex)[i]));
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t corner : triangle)
                flat.corners.push_back(first + corner);
    };
    while (!stack.empty()) {
        const Piece piece = stack.back();
        stack.pop_back();
        const CutNode& node = cut.nodes[piece.node];
        const bool is_cut = graftal::is_cut(node, piece.steps, detail_of(cut, model.projection, piece),
                                            model.projection.error_px());
        if (node.primitive)
            add(*node.primitive, piece.world_from_node);
        else if (followed_edges(node, is_cut).empty())
            add(PrimitiveKind::sphere, piece.world_from_node * node.node_from_proxy);
        else
            for (const CutEdge& edge : followed_edges(node, is_cut))
                stack.push_back(descend(cut, piece, edge, is_cut));
    }
    return flat;
}

/// The rays as Embree meets them, from `least` on.
void mesh(const TraceModel& model, const std::vector<Ray>& rays, double least, bool coherent) {
    Flat flat = flatten(model);
    flat.vertices.push_back(0); // Embree reads a little beyond
    const double start = now();
    const RTCDevice device = rtcNewDevice("threads=2");
    const RTCScene scene = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, flat.vertices.data(),
                               0, 3 * sizeof(float), flat.vertices.size() / 3);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, flat.corners.data(), 0,
                               3 * sizeof(unsigned), flat.corners.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    std::printf("%zu triangles, built in %.2f s:", flat.corners.size() / 3, now() - start);
    measure(rays, [&] {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        std::size_t hits = 0;
        for (const Ray& ray : rays) {
            RTCRayHit query{};
            query.ray.org_x = static_cast<float>(ray.origin.x);
            query.ray.org_y = static_cast<float>(ray.origin.y);
            query.ray.org_z = static_cast<float>(ray.origin.z);
            query.ray.dir_x = static_cast<float>(ray.direction.x);
            query.ray.dir_y = static_cast<float>(ray.direction.y);
            query.ray.dir_z = static_cast<float>(ray.direction.z);
            query.ray.tnear = static_cast<float>(least);
            query.ray.tfar = INFINITY;
            query.ray.mask = UINT32_MAX;
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &query);
            hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
        return hits;
    });
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    const std::string mode = argc > 3 ? argv[1] : "";
    if (mode == "graph" && argc == 5) {
        graftal::graph(*graftal::load(argv[2], argv[3], std::strtod(argv[4], nullptr)));
    } else if (mode == "light" && argc == 5) {
        graftal::light(*graftal::load(argv[2], argv[3], std::strtod(argv[4], nullptr)));
    } else if (mode == "mesh" && argc == 4) {
        const auto model = graftal::load(argv[2], argv[3], 0);
        graftal::mesh(*model, graftal::camera_rays(model->view), 0, true);
    } else if (mode == "mesh_light" && argc == 4) {
        const auto model = graftal::load(argv[2], argv[3], 0);
        graftal::mesh(*model, graftal::scattered_rays(*model), graftal::least_distance(*model), false);
    } else {
        std::fputs("usage: tracer_bench graph|light MODEL STEPS ERROR_PX | mesh|mesh_light MODEL STEPS\n",
                   stderr);
        return 2;
    }
}
