#include "compiler/detail/shell/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/mesh/slot_table.h"
#include "compiler/detail/shell/cell_table.h"

namespace graftal {

namespace {

constexpr int smoothings = 2;
/// Triangles for each point in space, in the mean: points that lie behind others have none.
constexpr double triangles_a_point = 3;
/// Work of a point's cells and their faces, in moves of a point.
constexpr std::uint64_t work_of_surface = 10;
/// The points' share of the work: the rest is for their surface, and for a coarser one if need be.
constexpr double share_of_work_for_points = 0.8;
/// A surface of too many triangles tells how many more there would be: its cells grow by that, somewhat more,
/// and no more than this at once.
constexpr int most_tries = 4;
constexpr double coarser_for_triangles = 1.25, least_share_built = 0.1;
/// Cells, or quads, after which it asks whether somebody still wants it.
constexpr std::uint64_t cells_a_look = 1 << 14;
/// Colours are told apart no better than this.
constexpr double colour_grain = 1.0 / 255;

struct Corner {
    Vec3 place{0.0}; ///< in cells
    Vec3 normal{0.0};
};

struct Quad {
    std::array<std::uint32_t, 4> corners;
    std::uint32_t point; ///< whose colour it has
};

/// Cells, and the faces between the filled and the empty.
class Surface {
  public:
    Surface(const PointSet& set, std::size_t max_quads, const CancelFlag& cancel)
        : control_{cancel, {}}, set_(set), max_quads_(max_quads) {}

    /// The share of the cells whose faces there was room for: the surface is whole where it is 1.
    double build() {
        fill();
        const double share = set_.flat ? add_sheet() : add_faces();
        if (share < 1) return share;
        cells_.clear();
        corner_numbers_.clear();
        corner_keys_.clear();
        order_.clear();
        if (!set_.flat) smooth();
        find_normals();
        return 1;
    }

    std::vector<Corner> corners;
    std::vector<Quad> quads;

  private:
    static constexpr std::array<std::array<int, 3>, 3> axes = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};

    /// A point fills the cells about it, eight or, in the plane, four: points that went from grid to grid
    /// leave gaps.
    void fill() {
        const int deep = set_.flat ? 0 : 1;
        for (std::uint32_t number = 0; number < set_.points.size(); ++number)
            take(place_of(number, 0.0), number);
        meter_.add(set_.points.size());
        for (std::uint32_t number = 0; number < set_.points.size(); ++number) {
            meter_.add();
            const CellKey first = place_of(number, 0.5);
            for (int z = 0; z <= deep; ++z)
                for (int y = 0; y <= 1; ++y)
                    for (int x = 0; x <= 1; ++x)
                        take({first.x + x, first.y + y, set_.flat ? 0 : first.z + z}, number);
        }
    }

    CellKey place_of(std::uint32_t number, double less) const {
        const auto& p = set_.points[number];
        const auto at = [&](std::size_t k) {
            return static_cast<std::int64_t>(std::floor(static_cast<double>(p[k]) / set_.cell - less));
        };
        return {at(0), at(1), set_.flat ? 0 : at(2)};
    }

    void take(const CellKey& key, std::uint32_t point) {
        const auto next = static_cast<std::uint32_t>(order_.size());
        const auto packed_of = [&](std::uint32_t i) { return order_[i].first; };
        if (cells_.find_or_add(key.packed(), next, packed_of) == next)
            order_.emplace_back(key.packed(), point);
    }

    bool is_filled(const CellKey& key) const {
        if (cells_.find(key.packed(), [&](std::uint32_t i) { return order_[i].first; }) != CellTable::none)
            return true;
        const auto middle = [&](std::int64_t place) {
            return static_cast<float>((static_cast<double>(place) + 0.5) * set_.cell);
        };
        return set_.is_inside({middle(key.x), middle(key.y), middle(key.z)});
    }

    std::uint32_t corner(const CellKey& key) {
        const auto next = static_cast<std::uint32_t>(corners.size());
        const std::uint32_t number =
            corner_numbers_.find_or_add(key.packed(), next, [&](std::uint32_t i) { return corner_keys_[i]; });
        if (number != next) return number;
        corner_keys_.push_back(key.packed());
        corners.push_back(
            {Vec3(static_cast<double>(key.x), static_cast<double>(key.y), static_cast<double>(key.z)),
             Vec3(0.0)});
        return number;
    }

    double add_sheet() {
        const double plane = static_cast<double>(set_.points.front()[2]) / set_.cell;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            meter_.add();
            const auto& [packed, point] = order_[i];
            const CellKey at = CellKey::unpacked(packed);
            quads.push_back({{corner(at), corner({at.x + 1, at.y, 0}), corner({at.x + 1, at.y + 1, 0}),
                              corner({at.x, at.y + 1, 0})},
                             point});
            if (quads.size() > max_quads_) return share_before(i);
        }
        for (Corner& at : corners)
            at.place.z = plane;
        return 1;
    }

    double add_faces() {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            meter_.add();
            const auto& [packed, point] = order_[i];
            const CellKey at = CellKey::unpacked(packed);
            for (int axis = 0; axis < 3; ++axis)
                for (const int side : {-1, 1}) {
                    const auto step = [&](CellKey key, int along, std::int64_t by) {
                        (along == 0 ? key.x : along == 1 ? key.y : key.z) += by;
                        return key;
                    };
                    if (is_filled(step(at, axis, side))) continue;
                    // Counter-clockwise from outside.
                    const int u = axes[static_cast<std::size_t>(axis)][side > 0 ? 1 : 2],
                              v = axes[static_cast<std::size_t>(axis)][side > 0 ? 2 : 1];
                    const CellKey low = side > 0 ? step(at, axis, 1) : at;
                    const CellKey right = step(low, u, 1);
                    quads.push_back(
                        {{corner(low), corner(right), corner(step(right, v, 1)), corner(step(low, v, 1))},
                         point});
                }
            if (quads.size() > max_quads_) return share_before(i);
        }
        return 1;
    }

    double share_before(std::size_t cell) const {
        return static_cast<double>(cell) / static_cast<double>(order_.size());
    }

    /// Each corner towards the mean of its neighbours, but no farther than half a cell.
    void smooth() {
        std::vector<Vec3> start, sum;
        std::vector<std::uint32_t> count;
        for (const Corner& at : corners)
            start.push_back(at.place);
        for (int i = 0; i < smoothings; ++i) {
            sum.assign(corners.size(), Vec3(0.0));
            count.assign(corners.size(), 0);
            for (const Quad& quad : quads) {
                meter_.add();
                for (std::size_t k = 0; k < 4; ++k)
                    for (const std::size_t other : {(k + 1) % 4, (k + 3) % 4}) {
                        sum[quad.corners[k]] += corners[quad.corners[other]].place;
                        ++count[quad.corners[k]];
                    }
            }
            for (std::size_t c = 0; c < corners.size(); ++c) {
                const Vec3 mean = sum[c] / static_cast<double>(count[c]);
                corners[c].place = glm::clamp(mean, start[c] - 0.5, start[c] + 0.5);
            }
        }
    }

    void find_normals() {
        for (const Quad& quad : quads) {
            const Vec3 normal = glm::cross(corners[quad.corners[2]].place - corners[quad.corners[0]].place,
                                           corners[quad.corners[3]].place - corners[quad.corners[1]].place);
            for (const std::uint32_t c : quad.corners)
                corners[c].normal += normal;
        }
        std::vector<Vec3> sum;
        for (int i = 0; !set_.flat && i < smoothings; ++i) {
            sum.assign(corners.size(), Vec3(0.0));
            for (const Quad& quad : quads) {
                meter_.add();
                Vec3 mean(0.0);
                for (const std::uint32_t c : quad.corners)
                    mean += normalised(corners[c].normal);
                for (const std::uint32_t c : quad.corners)
                    sum[c] += mean;
            }
            for (std::size_t c = 0; c < corners.size(); ++c)
                corners[c].normal = sum[c];
        }
        for (Corner& at : corners)
            at.normal = normalised(at.normal);
    }

    static Vec3 normalised(Vec3 v) {
        const double length = glm::length(v);
        return length > 1e-9 ? v / length : Vec3(0, 1, 0);
    }

    const Control control_;
    WorkMeter meter_{control_, "shell", cells_a_look};
    const PointSet& set_;
    const std::size_t max_quads_;
    CellTable cells_;
    CellTable corner_numbers_;
    std::vector<std::uint64_t> corner_keys_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order_; ///< filled cells, and whose colour they have
};

/// Sorts the quads into parts of one finish each.
class ShellParts {
  public:
    ShellParts(const PointSet& set, const Surface& surface, const ShellRequest& request,
               double body_from_node)
        : set_(set), surface_(surface), request_(request), scale_(set.cell * body_from_node) {}

    std::vector<BakedPart> take() {
        const Control control{request_.cancel, {}};
        WorkMeter meter(control, "shell", cells_a_look);
        for (const Quad& quad : surface_.quads) {
            meter.add();
            add(quad);
        }
        std::vector<BakedPart> parts;
        for (auto& [material, part] : parts_) {
            Mesh& mesh = part.mesh;
            mesh.slot_count = part.slots.slot_count();
            if (mesh.slot_count > 1)
                for (std::uint32_t quad = 0; quad < mesh.triangles.size() / 2; ++quad)
                    for (int i = 0; i < 2; ++i)
                        mesh.slot_of_triangle.push_back(part.slots.slot_of(quad));
            BakedPart baked;
            if (material >= 0)
                baked.material = static_cast<MaterialId>(material);
            else
                baked.material = request_.material;
            baked.mesh = std::move(mesh);
            baked.palettes = part.slots.take_palettes();
            parts.push_back(std::move(baked));
        }
        return parts;
    }

  private:
    struct Part {
        explicit Part(std::size_t painters, std::size_t corners)
            : slots(painters), vertex_of(corners, CellTable::none) {}
        Mesh mesh;
        SlotTable slots;
        std::vector<std::uint32_t> vertex_of; ///< by corner
    };

    void add(const Quad& quad) {
        const PointPaint paint = set_.paints.empty() ? PointPaint() : set_.paints[quad.point];
        Part& part = parts_.try_emplace(paint.material, request_.inherited.size(), surface_.corners.size())
                         .first->second;
        std::array<std::uint32_t, 4> vertex;
        for (std::size_t k = 0; k < 4; ++k) {
            std::uint32_t& number = part.vertex_of[quad.corners[k]];
            if (number == CellTable::none) {
                number = static_cast<std::uint32_t>(part.mesh.vertices.size());
                const Corner& corner = surface_.corners[quad.corners[k]];
                part.mesh.vertices.push_back(scale_ * corner.place);
                part.mesh.normals.push_back(corner.normal);
            }
            vertex[k] = number;
        }
        part.mesh.triangles.push_back({vertex[0], vertex[1], vertex[2]});
        part.mesh.triangles.push_back({vertex[0], vertex[2], vertex[3]});
        colours_.clear();
        for (const Rgb& inherited : request_.inherited)
            colours_.push_back(glm::round(paint.over(inherited) / colour_grain) * colour_grain);
        part.slots.add(colours_);
    }

    const PointSet& set_;
    const Surface& surface_;
    const ShellRequest& request_;
    double scale_;
    std::map<std::int32_t, Part> parts_;
    std::vector<Rgb> colours_;
};

/// Fills in `baked`, if it can: its shell_work is right on any way out.
void bake_into(Baked& baked, const DetailGraph& cut, const ShellRequest& request, std::size_t max_triangles) {
    const Ball& ball = cut.nodes[request.node].ball;
    const double size = std::exp2(std::ceil(std::log2(std::max(ball.radius, 1e-200))));
    baked.representative_from_body = Affine::translate(ball.centre) * Affine::scale(Vec3(size));
    PointLimits limits;
    limits.points = std::min(
        limits.points, static_cast<std::size_t>(static_cast<double>(max_triangles) / triangles_a_point));
    limits.cancel = request.cancel;
    ShellStore of_this_shell;
    ShellStore& store = request.store ? *request.store : of_this_shell;
    baked.complete = false;
    std::uint64_t work_left = std::min(limits.work, request.most_work);
    double detail_per_unit = request.detail_per_unit;
    for (int tries = 0; tries < most_tries; ++tries) {
        limits.work = static_cast<std::uint64_t>(share_of_work_for_points * static_cast<double>(work_left));
        baked.shell_work += limits.work; // all that it may take, until it is known
        const auto set = store.points(cut, request.node, request.steps, detail_per_unit, limits);
        const std::uint64_t work = set->work + work_of_surface * set->points.size();
        work_left -= std::min(work_left, work);
        baked.shell_work += work - limits.work;
        if (set->points.empty()) return;
        Surface surface(*set, max_triangles / 2, request.cancel);
        const double share_built = surface.build();
        if (share_built == 1) {
            baked.triangles = 2 * surface.quads.size();
            baked.culled_detail = std::max(1.0, set->cell * request.detail_per_unit);
            baked.parts = ShellParts(*set, surface, request, 1 / size).take();
            baked.complete = true;
            return;
        }
        detail_per_unit =
            std::max(std::sqrt(share_built), least_share_built) / (coarser_for_triangles * set->cell);
    }
}

} // namespace

Baked bake_shell(const DetailGraph& cut, const ShellRequest& request, std::size_t max_triangles) {
    Baked baked;
    try {
        bake_into(baked, cut, request, max_triangles);
    } catch (const std::bad_alloc&) {
        baked.complete = false;
    }
    return baked;
}

} // namespace graftal
