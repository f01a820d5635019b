#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "compiler/detail/graph/alike_set.h"
#include "compiler/detail/work.h"
#include "compiler/primitives/intersect.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/shade/surfaces.h"

namespace graftal {

/// Instructions by which rays are traced. The results are the same to the last bit.
enum class Instructions { portable, avx2 };

/// The fastest that this machine has.
Instructions best_instructions();

/// Parts smaller than this are nothing: their inverse maps would not be numbers.
inline constexpr double least_scale = 1e-150;

/// The line or the plane in which the image of a singular map lies, as a ray sees it.
class FlatImage {
  public:
    FlatImage() = default;
    FlatImage(const Ray& ray, const Mat3& map, Vec3 point);

    /// Where the ray is no farther from it; empty where least > most.
    RayRange within(double width) const;
    /// Half the thickness of the image of the unit ball, or up to three times as much.
    double thickness() const { return thickness_; }

  private:
    double a_ = 0, b_ = 0, c_ = 0, thickness_ = 0;
    bool parallel_ = true;
};

/// Takes rays through the graph itself (J. Hart and T. DeFanti, "Efficient Antialiased Rendering of 3-D
/// Linear Fractals", 1991): depth first, the nearest child first, into each child's frame, and only as deep
/// as the parts are that the view shows. What is drawn of a node is what the cut draws of it
/// (povray/cut/cut.h), part by part. Memory O(depth). For one thread.
class Traversal final : public Surfaces {
  public:
    explicit Traversal(const TraceModel& model, Instructions instructions = best_instructions());
    ~Traversal() override;

    bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) override;
    std::uint32_t closest_each(std::span<const Ray> rays, const RayRange& range,
                               std::span<SurfaceHit> hits) override;
    bool meets_any(const Ray& ray, const RayRange& range) override;
    bool all_opaque() const override;
    /// Whether several rays may go together at all: in even models, whose rays keep their directions.
    bool takes_packets() const { return packet_ != nullptr; }

    /// Whether hits say of what instance they are (SurfaceHit::instance).
    void tell_instances(bool tells) { tells_instances_ = tells; }

    /// Begins with another ray of the camera. It, and all rays that it makes, may go into some times as many
    /// parts as one ray may: light that goes through thousands of panes would not come to an end.
    void begin_path() { path_limit_ = visits_ + most_full_rays * model_.most_visits; }

    /// Nodes and primitives that rays went into so far.
    std::uint64_t visits() const { return visits_; }
    /// Work of these visits and of boxes (RayWork, compiler/detail/work.h).
    std::uint64_t work() const { return RayWork::part * visits_ + boxes_ + more_work_; }
    /// Rays that went into too many parts. They meet the best hit by then. Without one, a ray meets parts
    /// that it had not yet looked into as wholes, each as if it were small enough to be culled.
    std::uint64_t given_up() const { return given_up_; }

  private:
    class Operands;                                              ///< of a combined object (combined.cpp)
    struct Boundary;                                             ///< of a combined object
    struct Places;                                               ///< which parts are looked into (places.h)
    template<Instructions instructions, bool any> struct Kernel; ///< the traversal proper (kernel.h)
    struct EvenPlaces; ///< which parts of an even model are looked into (even_places.h)
    template<Instructions instructions, bool any> struct EvenKernel; ///< through even models (even.h)
    template<Instructions instructions> struct Packet; ///< eight rays at once through even models (packet.h)
    struct PacketRoom;                                 ///< their memory
    struct LaterEntries;                               ///< entries for a ray to look into later

    /// The ray in some frame: origin + (t - base) / unit * direction.
    struct LocalRay {
        Double4 origin, direction; ///< the direction's largest component is 1, within a small factor
        double base = 0;
        double unit = 1;  ///< of t
        double speed = 1; ///< 1 / unit
    };

    /// An object on the way from the root, and the ray in its frame.
    struct alignas(32) Frame : LocalRay {
        LaneMap world_from_node;
        double scale = 1;        ///< norm of world_from_node
        double flatness = 1;     ///< at most its least stretch, as a share of the largest
        double least_detail = 0; ///< least detail of a unit in its entries' children
        std::uint32_t edge = 0;
        std::uint32_t node = 0;
        std::uint32_t steps = 0;
        bool cut = false;    ///< drawn by its stop edges
        bool items = false;  ///< its entries are items of a run, not edges
        bool faint = false;  ///< they stand for a set without area (least_width.h)
        bool specks = false; ///< they lead to nodes that are cut and faint
        Vec3 margin{0.0};    ///< largest reach of parts out of their boxes
        float least = 0;     ///< where the ray begins, in units from the base
        /// Values by axis: the side of boxes where the ray goes in; the origin less the margin, for that
        /// side and for the other; and the reciprocal of the direction.
        Int4 side_in;
        Float4 origin_in, origin_out, reciprocal;
    };

    /// An edge or a node of boxes to go into, and from where on.
    struct Entry {
        float at = 0; ///< in units from the frame's base
        std::uint32_t entry = 0;
        std::uint32_t frame = 0;
    };
    /// One that is kept for later.
    struct Later {
        std::int64_t key = 0; ///< where it is, and its number: the nearer, the less
        std::uint32_t frame = 0;
    };

    /// An object on the way from the root of an even model, wherever the ray is.
    struct alignas(32) EvenPlace {
        Double4 offset;   ///< translation of world_from_node
        double entry = 1; ///< and its scale; `scale`, a product of norms, may differ by a rounding
        double scale = 1;
        double least_detail = 0, most_detail = 0; ///< of a unit anywhere within the node's reach, or outside
        std::uint32_t edge = 0, node = 0, steps = 0;
        bool cut = false;
    };
    /// An EvenPlace and the ray in its frame. In even models, rays have one direction in all frames.
    struct alignas(64) EvenFrame : EvenPlace {
        Double4 origin;
        double base = 0, unit = 1, speed = 1;
        Float4 near; ///< the origin
        float least = 0;
    };
    /// Where the root of an even model lies, and what rays look into there.
    struct EvenRoot {
        EvenPlace place;
        std::uint32_t tree = no_tree; ///< none: it is entered as any other part
    };
    /// The tree that rays look into for a node with `steps` levels left, where nothing is culled.
    struct EvenTree {
        std::uint32_t node = no_edge, steps = 0;
        std::uint32_t tree = no_tree;
        bool cut = false;
    };

    /// The best hit so far.
    struct Best {
        double t = 0;
        bool found = false;
        Vec3 normal{0.0};             ///< in the leaf's frame
        Vec3 point{0.0};              ///< of a primitive, likewise
        double turns = 1;             ///< of a primitive (TraceEdge)
        LaneMap world_from_leaf;      ///< unless
        bool is_upright = false;      ///< true if it only scales evenly and moves: it keeps normals
        std::uint32_t proxy_node = 0; ///< or no_edge
        const TraceMesh::Colour* mesh_colour = nullptr; ///< of a triangle
        double cell = 0;                                ///< of its shell, in the world
        bool in_world = false; ///< the proxy was met there: so are its normal and point
        bool crushed = false;  ///< a crushed part shows the proxies' own normals
        bool inverted = false; ///< the inner side of what a difference takes away

        /// Takes another hit, as one of a primitive in its frame: whoever meets it says where it differs.
        void renew() {
            found = true;
            mesh_colour = nullptr;
            is_upright = in_world = crushed = inverted = false;
        }
    };

    /// Boundaries that a ray asks for.
    enum class Search : std::uint8_t {
        surface, ///< the first one, whichever it is
        entry,   ///< the first by which it enters a solid
        inside,  ///< of the solids that it is in where the range begins, the last by which it leaves one
    };
    /// Asks operands of a frame's combined object: the edges [first, end), those in the tree apart, and the
    /// tree. `frame`: its copy. Requires a search for solids.
    bool ask_operands(const Ray& ray, const Frame& frame, std::uint32_t first, std::uint32_t end,
                      std::uint32_t tree, const RayRange& range);
    /// Meets the combined object of a frame; true if there is something nearer, and its way is kept.
    bool meet_combined(std::uint32_t frame_number, const RayRange& range);
    /// meet(), for solids where they are searched.
    bool meet_asked(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit);
    bool searches_solids() const { return search_ != Search::surface; }

    const TraceMesh& shell_of(const Frame& frame);
    /// A part that is met in the world.
    struct FlatPart {
        LaneMap world_from_node;
        double scale = 1;
        std::uint32_t edge = 0; ///< the edge to it, marked if from a cut node
        std::uint32_t steps = 0;
        std::uint32_t depth = 0; ///< edges on the way from the frame before it
        bool faint = false;
        bool placed_first = false; ///< nothing bounded is above it that the flat map places
    };

    /// Meets the child of a frame's edge where no ray can be taken into the child's frame (flat_walk.cpp).
    void meet_flat(std::uint32_t frame_number, std::uint32_t edge, const RayRange& range, bool any);
    /// Looks where the ray is in the flat image of a part that is placed first; false if nowhere.
    bool begin_flat(const FlatPart& part, const RayRange& range);
    void meet_flat_part(const FlatPart& part, const RayRange& range, std::uint32_t frame_number);
    /// The parts of what holds planes, which has no bounds.
    void push_flat_parts(const FlatPart& part, const TraceNode& node);
    void meet_flat_items(const FlatPart& part, const Ball& ball, const RayRange& range,
                         std::uint32_t frame_number);
    /// The edges to a part that was met in the world.
    void keep_flat_way(std::uint32_t frame_number);
    /// At most the flatness of what the edge places; 0 where that is too flat for a frame.
    static double placed_flatness(const LaneMap& world_from_node, const TraceEdge& edge);
    /// The child that a part's edge leads to, except for its scale: many are missed that need none.
    FlatPart flat_child(const LaneMap& world_from_node, std::uint32_t edge, std::uint32_t steps,
                        bool cut) const;
    void scale_child(FlatPart& child, double parent_scale) const;
    /// About all that is drawn of the part, as thin as it is, if it is scaled so.
    Ball drawn_ball(const FlatPart& part, double scale) const;
    /// False where the ray misses a ball about the part that is a little too large.
    bool may_meet(const FlatPart& part, const RayRange& range) const;
    double flat_width(const Ball& ball, double scale) const;
    bool is_new(const FlatPart& part, double width);
    /// Meets a proxy or primitive in the world, as it is drawn (least_width.h); true if it is the nearest so
    /// far, and its way is to be kept. `ball`: of the node that it is or stands for, in the world.
    bool meet_leaf(const Primitive& primitive, const Affine& world_from_leaf, bool faint, const Ball& ball,
                   const RayRange& range);
    /// Meets a primitive that is drawn at this place, which is regular.
    bool meet_drawn(const Primitive& primitive, const Affine& drawn, const RayRange& range);
    /// The edges to a frame's node.
    void keep_way(std::uint32_t frame_number);
    /// Fills in what is seen at the best hit.
    void show_best(SurfaceHit& hit);
    std::uint32_t instance_at_best();
    std::uint32_t run_packet(std::span<const Ray> rays, const RayRange& range, std::uint32_t& to_go_alone);
    void show_packed(std::size_t lane, const Ray& ray, std::span<SurfaceHit> hits);
    template<template<Instructions, bool> typename AnyKernel, bool any, typename... From>
    bool run(const Ray& ray, const RayRange& range, const From*... from);
    template<bool any> bool run(const Ray& ray, const RayRange& range);
    /// Takes patience for parts that lanes saw are not met, as visits to them would.
    void lose_patience(std::uint64_t parts) { patience_ -= std::min(patience_, parts); }
    /// Parts that the next ray may go into: few where the camera's ray has had its share.
    std::uint64_t visits_allowed() const {
        constexpr std::uint64_t least = 32;
        if (visits_ >= path_limit_) return std::min(least, model_.most_visits);
        return std::min(path_limit_ - visits_, model_.most_visits);
    }
    /// Counts parts that are looked at in the world. Each takes longer than many that are gone into, so they
    /// are of the visits that a ray may make, but take no patience.
    void look_at_flat(std::uint64_t parts) {
        const std::uint64_t work = RayWork::crushed * parts;
        visits_ += work / RayWork::part;
        patience_ += work / RayWork::part;
        more_work_ += work % RayWork::part;
    }
    /// False once the ray went into too many parts, and hurrying did not help.
    bool goes_on();
    /// intersect() of intersect.h within the visits that the ray has left, and what that took.
    bool meet(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
        const std::uint64_t left = visit_limit_ > visits_ ? visit_limit_ - visits_ : 1;
        return meet_within(primitive, ray, range, hit, left);
    }
    bool meet_within(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit,
                     std::uint64_t most_visits) {
        constexpr std::uint64_t steps_a_visit = RayWork::part / RayWork::mesh_step;
        hit.steps = 0;
        const bool met = intersect(primitive, ray, range, hit, most_visits * steps_a_visit);
        visits_ += hit.steps / steps_a_visit;
        more_work_ += RayWork::mesh_step * (hit.steps % steps_a_visit);
        return met;
    }
    /// Appends an edge to the path; of an unrolling's edge those that it stands for.
    void append_to_path(std::uint32_t edge);
    /// The look that a way has given to its end.
    struct WayLook : Look {
        std::uint32_t parent = 0; ///< if it has_mean
        bool has_mean = false;
    };
    void look_along(std::uint32_t step, WayLook& look, SurfaceHit& hit) const;
    void surface_at_best(SurfaceHit& hit) const;
    Vec3 normal_at_best() const;
    const Primitive& primitive_at_best() const; ///< unless a proxy or a shell was met
    Vec3 to_far_side_at_best() const;           ///< SurfaceHit's
    Rgb pattern_at_best(double size, SurfaceHit& hit) const;
    double light_share_at_best() const;
    /// The material that an edge gives, the nearest to its child if it stands for several.
    std::optional<MaterialId> material_of(std::uint32_t edge) const;
    const Texture::Texel& texel(MaterialId material, std::uint32_t edge, double turns, Vec3 point) const;
    /// Whether the child of the edge, met at this point of its surface, has none there.
    bool is_clear(std::uint32_t edge, std::uint32_t frame, double turns, Vec3 point) const;

    const TraceModel& model_;
    Instructions instructions_;
    std::vector<Frame> frames_;
    std::vector<Later> later_;
    std::vector<EvenFrame> even_frames_;
    EvenRoot even_root_;
    std::array<EvenTree, 64> even_trees_; ///< by a hash
    std::unique_ptr<PacketRoom> packet_;  ///< null where rays go one by one
    Best best_;
    /// Shells asked for lately, by a hash of their keys: the store has to be locked.
    std::array<std::pair<PieceKind, const TraceMesh*>, 64> meshes_{};
    Ray ray_;                          ///< in the world
    std::vector<FlatPart> flat_parts_; ///< to be met
    FlatImage flat_image_;
    double flat_enough_ = 0;              ///< nearer than this no part of the image is
    AlikeSet flat_met_;                   ///< once patience is at its end
    std::uint64_t patience_ = 0;          ///< of the ray: visits
    std::vector<std::uint32_t> flat_way_; ///< edges from the frame to the part under way
    std::uint64_t visit_limit_ = 0;       ///< of the ray
    static constexpr std::uint64_t most_full_rays = 4;
    std::uint64_t path_limit_ = UINT64_MAX; ///< of the camera's ray
    bool hurries_ = false;                  ///< the ray has passed the limit
    Search search_ = Search::surface;
    double leaves_ = 0;                ///< where the ray leaves what it is in, as far as is known
    std::unique_ptr<Traversal> inner_; ///< goes through operands; made when it is first needed
    std::vector<std::uint32_t>
        way_; ///< edges through the frames to the best hit, those from cut nodes marked
    std::vector<std::uint32_t> path_; ///< of the graph, likewise, once the ray is done
    bool tells_instances_ = false;
    std::vector<std::uint32_t> instance_way_; ///< by its numbers, once the ray is done
    std::uint64_t visits_ = 0;
    std::uint64_t boxes_ = 0;     ///< tests of boxes (RayWork::boxes)
    std::uint64_t more_work_ = 0; ///< besides both
    std::uint64_t given_up_ = 0;
};

} // namespace graftal
