#include "tests/bench/embree_rays.h"

#include <cmath>
#include <ctime>
#include <map>
#include <utility>

#include "compiler/detail/piece.h"
#include "compiler/primitives/tessellate.h"

namespace graftal {

struct EmbreeScene::Flat {
    std::vector<float> vertices;
    std::vector<unsigned> corners;
};

/// Follows a model's pieces.
struct EmbreeScene::Builder {
    const TraceModel& model;
    const DetailGraph& cut = model.prepared.cut;
    using Kind = std::pair<NodeId, std::uint32_t>; ///< a node and its levels left
    std::map<Kind, double> counts = {};

    bool is_cut(const Piece& piece) const {
        return graftal::is_cut(cut.nodes[piece.node], piece.steps, detail_of(cut, model.projection, piece),
                               model.projection.error_px());
    }

    Piece root() const {
        Piece piece;
        piece.node = cut.root;
        piece.steps = model.prepared.root_steps;
        return piece;
    }

    /// Triangles of a piece.
    double count(const Piece& piece) {
        const DetailNode& node = cut.nodes[piece.node];
        if (node.primitive) return static_cast<double>(tessellated(*node.primitive, 0).triangles.size());
        const auto [known, added] = counts.emplace(Kind{piece.node, piece.steps}, 0);
        if (!added) return known->second;
        double sum = 0;
        const bool is_cut = this->is_cut(piece);
        for (const DetailEdge& edge : followed_edges(node, is_cut))
            sum += count(descend(cut, piece, edge, is_cut));
        return counts[{piece.node, piece.steps}] = sum;
    }

    void flatten(const Piece& piece, Flat& flat) const {
        const DetailNode& node = cut.nodes[piece.node];
        if (node.primitive) return add(*node.primitive, piece.world_from_node, flat);
        const bool is_cut = this->is_cut(piece);
        if (followed_edges(node, is_cut).empty())
            return add(PrimitiveKind::sphere, piece.world_from_node * node.node_from_proxy, flat);
        for (const DetailEdge& edge : followed_edges(node, is_cut))
            flatten(descend(cut, piece, edge, is_cut), flat);
    }

    static void add(const Primitive& kind, const Affine& place, Flat& flat) {
        const TessellatedPrimitive& mesh = tessellated(kind, 0);
        const auto first = static_cast<unsigned>(flat.vertices.size() / 3);
        for (const Vec3& vertex : mesh.vertices)
            for (int i = 0; i < 3; ++i)
                flat.vertices.push_back(static_cast<float>(place(vertex)[i]));
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t corner : triangle)
                flat.corners.push_back(first + corner);
    }
};

namespace {

bool note_memory(void* bytes, ssize_t change, bool) {
    *static_cast<std::size_t*>(bytes) += static_cast<std::size_t>(change);
    return true;
}

double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

RTCIntersectContext context_of(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

template<std::size_t size, typename Packet, typename Intersect>
std::size_t hits_by(std::span<const Ray> rays, std::size_t width, const Intersect& intersect) {
    constexpr std::size_t across = 4;
    alignas(64) int valid[size];
    for (int& lane : valid)
        lane = -1;
    std::size_t hits = 0;
    for (std::size_t first = 0; first < rays.size(); first += width * (size / across))
        for (std::size_t x = 0; x < width; x += across) {
            Packet packet;
            for (std::size_t lane = 0; lane < size; ++lane) {
                const Ray& ray = rays[first + lane / across * width + x + lane % across];
                packet.ray.org_x[lane] = static_cast<float>(ray.origin.x);
                packet.ray.org_y[lane] = static_cast<float>(ray.origin.y);
                packet.ray.org_z[lane] = static_cast<float>(ray.origin.z);
                packet.ray.dir_x[lane] = static_cast<float>(ray.direction.x);
                packet.ray.dir_y[lane] = static_cast<float>(ray.direction.y);
                packet.ray.dir_z[lane] = static_cast<float>(ray.direction.z);
                packet.ray.tnear[lane] = packet.ray.time[lane] = 0;
                packet.ray.tfar[lane] = INFINITY;
                packet.ray.mask[lane] = UINT32_MAX;
                packet.ray.flags[lane] = 0;
                packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
                packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
            }
            intersect(valid, packet);
            for (const unsigned id : packet.hit.geomID)
                hits += id != RTC_INVALID_GEOMETRY_ID;
        }
    return hits;
}

} // namespace

EmbreeScene::EmbreeScene(const TraceModel& model, Form form) {
    device_ = rtcNewDevice("threads=2");
    rtcSetDeviceMemoryMonitorFunction(device_, note_memory, &embree_bytes_);
    Builder builder{model};
    const double all = builder.count(builder.root());
    triangles_ = static_cast<std::size_t>(all);
    const double start = processor_seconds();
    if (form == Form::mesh) {
        flats_.push_back(std::make_unique<Flat>());
        builder.flatten(builder.root(), *flats_.back());
        scene_ = mesh_of(*flats_.back());
        build_seconds_ = processor_seconds() - start;
        return;
    }
    // About as many instances as triangles in a mesh.
    const double most = 4 * std::sqrt(all);
    std::map<Builder::Kind, RTCScene> meshes;
    scene_ = rtcNewScene(device_);
    std::vector<Piece> stack = {builder.root()};
    while (!stack.empty()) {
        const Piece piece = stack.back();
        stack.pop_back();
        const bool is_cut = builder.is_cut(piece);
        const auto edges = followed_edges(builder.cut.nodes[piece.node], is_cut);
        if (!edges.empty() && builder.count(piece) > most) {
            for (const DetailEdge& edge : edges)
                stack.push_back(descend(builder.cut, piece, edge, is_cut));
            continue;
        }
        RTCScene& mesh = meshes[{piece.node, piece.steps}];
        if (!mesh) {
            Piece at_home;
            at_home.node = piece.node;
            at_home.steps = piece.steps;
            flats_.push_back(std::make_unique<Flat>());
            builder.flatten(at_home, *flats_.back());
            mesh = mesh_of(*flats_.back());
            meshes_.push_back(mesh);
        }
        float columns[12];
        for (int i = 0; i < 12; ++i)
            columns[i] = static_cast<float>(i < 9 ? piece.world_from_node.linear[i / 3][i % 3]
                                                  : piece.world_from_node.translation[i - 9]);
        const RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, mesh);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometry(scene_, instance);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(scene_);
    build_seconds_ = processor_seconds() - start;
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    for (const RTCScene mesh : meshes_)
        rtcReleaseScene(mesh);
    rtcReleaseDevice(device_);
}

RTCScene EmbreeScene::mesh_of(const Flat& flat) const {
    auto& vertices = const_cast<std::vector<float>&>(flat.vertices);
    auto& corners = const_cast<std::vector<unsigned>&>(flat.corners);
    vertices.push_back(0); // Embree reads a little beyond
    const RTCScene scene = rtcNewScene(device_);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                               3 * sizeof(float), vertices.size() / 3);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners.data(), 0,
                               3 * sizeof(unsigned), corners.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

double EmbreeScene::mib() const {
    std::size_t bytes = embree_bytes_;
    for (const auto& flat : flats_)
        bytes += sizeof(float) * flat->vertices.size() + sizeof(unsigned) * flat->corners.size();
    return static_cast<double>(bytes) / (1 << 20);
}

std::size_t EmbreeScene::hits(std::span<const Ray> rays, double least, bool coherent) const {
    RTCIntersectContext context = context_of(coherent);
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
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

std::size_t EmbreeScene::hits_by_8(std::span<const Ray> rays, std::size_t width) const {
    RTCIntersectContext context = context_of(true);
    return hits_by<8, RTCRayHit8>(rays, width, [&](const int* valid, RTCRayHit8& packet) {
        rtcIntersect8(valid, scene_, &context, &packet);
    });
}

std::size_t EmbreeScene::hits_by_16(std::span<const Ray> rays, std::size_t width) const {
    RTCIntersectContext context = context_of(true);
    return hits_by<16, RTCRayHit16>(rays, width, [&](const int* valid, RTCRayHit16& packet) {
        rtcIntersect16(valid, scene_, &context, &packet);
    });
}

} // namespace graftal
