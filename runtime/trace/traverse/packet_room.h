#pragma once

// Memory of a packet of rays on its way (packet.h).

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/trace/traverse/traversal.h"

namespace graftal {

struct Traversal::PacketRoom {
    /// An object on the way from the root, and all rays in its frame.
    struct alignas(64) Frame : EvenPlace {
        Double8 origin[3]; ///< by axis
        Double8 base, unit, speed;
        Float8 near[3]; ///< the origin
        Float8 least;
        float extreme[2][3];         ///< the least and the greatest of the origins, by axis
        float first_least;           ///< the least of `least`
        Float8 most;                 ///< parts nearer than the best hits begin before this
        std::uint32_t hits_then = 0; ///< hits of the packet when that was so
    };

    /// An edge or a node of boxes that rays are to look into. Where each of them enters its box is computed
    /// again when it is taken: to keep that takes longer.
    struct Entry {
        float key = 0; ///< where one of the rays does
        std::uint32_t entry = 0;
        std::uint32_t frame = 0;
        std::uint32_t mask = 0;                             ///< one bit for each ray that meets its box
        std::uint32_t box = no_box;                         ///< eight times the node of boxes, and the lane
        static constexpr std::uint32_t no_box = UINT32_MAX; ///< the rays are at its beginning
    };

    /// A hit that some rays share; see Traversal::Best.
    struct Hit {
        LaneMap world_from_leaf; ///< unless it is upright
        bool is_upright = false;
        bool in_world = false;
        double turns = 1;
        std::uint32_t proxy_node = UINT32_MAX;
        std::size_t way = 0, way_end = 0; ///< of `ways`
        std::size_t shown = no_ray;       ///< a ray of which it is known what is seen there
        static constexpr std::size_t no_ray = SIZE_MAX;
    };

    bool has_textures = false; ///< then what is seen depends on where a part is met
    bool has_patterns = false; ///< likewise
    std::vector<Frame> frames = std::vector<Frame>(16);
    std::vector<Entry> entries = std::vector<Entry>(128);
    std::size_t top = 0; ///< entries in use
    std::vector<Hit> hits;
    std::vector<std::uint32_t> ways; ///< edges, one way after the other
    /// The best hit of a ray.
    struct Best {
        double t = 0;
        std::size_t hit = 0; ///< of `hits`
        Vec3 normal{0.0}, point{0.0};
    };
    std::array<Best, 8> best;

    void clear() {
        top = 0;
        hits.clear();
        ways.clear();
    }

    Entry* reserve(std::size_t count) {
        if (top + count > entries.size()) entries.resize(2 * entries.size());
        return entries.data() + top;
    }
};

} // namespace graftal
