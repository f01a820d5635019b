// Rays in packets: which models they go through, and what is seen at their hits.

#include <algorithm>
#include <bit>

#include "runtime/trace/traverse/packet_leaves.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

namespace {

/// Fewer rays go alone.
constexpr std::size_t least_packet = 3;

/// One bit for each ray.
struct Outcome {
    std::uint32_t found, to_go_alone;
};

// The packet is made in here: what nobody else has the address of stays in registers.
template<typename Packet>
Outcome run_packet(Traversal& traversal, std::span<const Ray> rays, const RayRange& range) {
    Packet packet(traversal, rays, range);
    packet.run();
    return {packet.found, packet.to_go_alone()};
}

template<typename Packet>
GRAFTAL_AVX2 Outcome run_packet_avx2(Traversal& traversal, std::span<const Ray> rays, const RayRange& range) {
    Packet packet(traversal, rays, range);
    packet.run();
    return {packet.found, packet.to_go_alone()};
}

} // namespace

std::uint32_t Traversal::run_packet(std::span<const Ray> rays, const RayRange& range,
                                    std::uint32_t& to_go_alone) {
    Outcome outcome;
    if constexpr (knows_avx2)
        outcome = instructions_ == Instructions::avx2
                      ? run_packet_avx2<Packet<Instructions::avx2>>(*this, rays, range)
                      : graftal::run_packet<Packet<Instructions::portable>>(*this, rays, range);
    else
        outcome = graftal::run_packet<Packet<Instructions::portable>>(*this, rays, range);
    to_go_alone = outcome.to_go_alone;
    return outcome.found & ~to_go_alone;
}

std::uint32_t Traversal::closest_each(std::span<const Ray> rays, const RayRange& range,
                                      std::span<SurfaceHit> hits) {
    // Rays that may be given up go alone: how far they come depends on the order of their parts.
    if (!packet_ || rays.size() < least_packet || model_.most_visits < TraceModel::usual_visits)
        return Surfaces::closest_each(rays, range, hits);
    std::uint32_t alone = 0;
    std::uint32_t found = run_packet(rays, range, alone);
    for (const PacketRoom::Hit& hit : packet_->hits) {
        const TraceLook& look = model_.looks[packet_->ways[hit.way_end - 1] & ~from_cut];
        if (look.as_one) continue;
        __builtin_prefetch(&model_.looks[look.before]);
        __builtin_prefetch(&model_.looks[look.last & ~from_cut]);
    }
    for (std::uint32_t left = found; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        show_packed(lane, rays[lane], hits);
    }
    for (; alone != 0; alone &= alone - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(alone));
        found |= static_cast<std::uint32_t>(closest(rays[lane], range, hits[lane])) << lane;
    }
    return found;
}

/// Shows the hit of a packet's ray. For rays that meet the same part, one has to look along the way there.
void Traversal::show_packed(std::size_t lane, const Ray& ray, std::span<SurfaceHit> hits) {
    const PacketRoom::Best& best = packet_->best[lane];
    PacketRoom::Hit& met = packet_->hits[best.hit];
    ray_ = ray;
    best_.renew();
    best_.t = best.t;
    best_.normal = best.normal;
    best_.point = best.point;
    best_.turns = met.turns;
    best_.is_upright = met.is_upright;
    if (!met.is_upright) best_.world_from_leaf = met.world_from_leaf;
    best_.proxy_node = met.proxy_node;
    best_.in_world = met.in_world;
    if (met.shown != PacketRoom::Hit::no_ray) {
        hits[lane] = hits[met.shown];
        hits[lane].t = best.t;
        const bool same_face = packet_->best[met.shown].normal == best.normal;
        if (same_face) return;
        hits[lane].normal = normal_at_best();
        // The sheet's other face was met.
        const Vec3& to_far_side = hits[lane].to_far_side;
        if (glm::dot(to_far_side, ray.direction) < 0) hits[lane].to_far_side = -to_far_side;
        return;
    }
    const auto way = packet_->ways.begin();
    way_.assign(way + static_cast<std::ptrdiff_t>(met.way), way + static_cast<std::ptrdiff_t>(met.way_end));
    show_best(hits[lane]);
    if (met.proxy_node == no_edge && !packet_->has_textures && !packet_->has_patterns) met.shown = lane;
}

} // namespace graftal
