#include "compiler/povray/cut/assemble.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "compiler/detail/bake.h"
#include "compiler/detail/shell/shares.h"
#include "compiler/detail/work.h"
#include "compiler/povray/costs.h"
#include "compiler/povray/cut/grouping.h"
#include "compiler/povray/cut/place_pieces.h"

namespace graftal {

namespace {

/// Work of a placement, in leaves: parts of meshes with pictures make materials and groups, too.
constexpr double work_of_grouping = 3;

/// Placements of meshes, counted before they are stored: a mesh may have hundreds of parts, of which the
/// choice knew nothing.
class PlacementCount {
  public:
    explicit PlacementCount(const PlacedPieces& pieces) : uses_(pieces.requests.size()) {
        for (const Placed& thing : pieces.things)
            if (!thing.textured && thing.request != Placed::no_request) {
                uses_[thing.request] += 1;
                all_uses_ += 1;
            }
    }

    /// The mesh of the next request.
    void add(std::size_t parts) {
        const double uses = uses_[next_++];
        counted_uses_ += uses;
        placements_ += uses * static_cast<double>(parts);
    }

    double bytes() const { return placements_ * PovrayCosts::placement; }
    /// Placements besides the first of each use, which is paid for when it is kept.
    double more() const { return std::max(0.0, placements_ - counted_uses_); }
    /// Bytes of all meshes, if the rest is as those that are counted, which take so many.
    double extrapolated(double counted) const {
        return counted_uses_ > 0 ? counted * all_uses_ / counted_uses_ : counted;
    }

  private:
    std::vector<double> uses_; ///< by request
    std::size_t next_ = 0;
    double all_uses_ = 0, counted_uses_ = 0, placements_ = 0;
};

std::optional<Cut> assemble_within(AssemblyLimits& limits, const DetailGraph& cut, const Symmetry& symmetry,
                                   const Projection& projection, const Piece& root, const Choice& choice,
                                   Weights& weights, bool limit_normals, ShellStore& shells,
                                   const SelfShadows* self_shadows) {
    std::optional<PlacedPieces> pieces =
        place_pieces(cut, symmetry, projection, root, choice, weights, limits, self_shadows);
    if (!pieces) return std::nullopt;
    ShellShares shell_shares(cut, pieces->requests);
    std::vector<Baked> baked;
    PlacementCount count(*pieces);
    double mesh_bytes = 0;
    double culled_detail = pieces->culled_detail;
    double tessellation_px = 0;
    for (BakeRequest& request : pieces->requests) {
        request.limit_normals = limit_normals;
        request.shells = &shells;
        request.self_shadows = self_shadows;
        const double memory_left = std::max(0.0, limits.memory_bytes - mesh_bytes);
        auto most_triangles = static_cast<std::size_t>(memory_left / PovrayCosts::triangle) + 1;
        if (request.shell) {
            const ShellShare share = shell_shares.take(request, limits.work_seconds, most_triangles);
            request.most_shell_work = share.work;
            most_triangles = share.triangles;
        }
        request.most_visits = static_cast<std::uint64_t>(std::min(limits.work_seconds, 1e6) *
                                                         WorkRates::visits / limits.slowness);
        request.most_made_triangles =
            static_cast<std::uint64_t>(std::min(limits.work_seconds, 1e6) * WorkRates::baked_triangles);
        baked.push_back(bake(cut, symmetry, request, most_triangles));
        if (limits.meter) limits.meter->add(baked.back().visits);
        for (const BakedPart& part : baked.back().parts)
            mesh_bytes += povray_bytes(part.mesh);
        limits.work_seconds -=
            limits.slowness * static_cast<double>(baked.back().visits) / WorkRates::visits +
            static_cast<double>(
                std::max<std::uint64_t>(baked.back().made_triangles, baked.back().triangles)) /
                WorkRates::baked_triangles +
            static_cast<double>(baked.back().shell_work) / WorkRates::shell_points;
        if (limits.work_seconds < 0) return std::nullopt;
        count.add(baked.back().parts.size());
        const double bytes = PovrayCosts::base + mesh_bytes + count.bytes();
        if (!baked.back().complete || bytes > limits.memory_bytes) {
            limits.needed_bytes = count.extrapolated(std::max(bytes, limits.memory_bytes));
            return std::nullopt;
        }
        culled_detail =
            std::max(culled_detail, baked.back().culled_detail * pieces->seen_share(baked.size() - 1));
        tessellation_px = std::max(tessellation_px, baked.back().tessellation_px);
    }
    limits.work_seconds -= work_of_grouping * count.more() / WorkRates::leaves;
    if (limits.work_seconds < 0) return std::nullopt;
    Grouping grouping(cut, *pieces, baked);
    for (const Placed& thing : pieces->things) {
        if (limits.meter)
            limits.meter->add(thing.request == Placed::no_request ? 1 : baked[thing.request].parts.size());
        grouping.add(thing);
    }
    const double finest_of_runs = pieces->runs.sift(cut, projection);
    for (const PlacedRuns::Range& range : pieces->runs.ranges())
        grouping.add(range);
    Cut result = std::move(grouping).take();
    result.combined = std::move(pieces->combined);
    result.error_px = culled_detail;
    result.tessellation_px = tessellation_px;
    result.finest = std::min(pieces->finest, finest_of_runs);
    result.leaf_count = choice.leaves;
    return result;
}

} // namespace

std::optional<Cut> assemble(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection,
                            const Piece& root, const Choice& choice, Weights& weights, bool limit_normals,
                            ShellStore& shells, AssemblyLimits& limits, const SelfShadows* self_shadows) {
    try {
        return assemble_within(limits, cut, symmetry, projection, root, choice, weights, limit_normals,
                               shells, self_shadows);
    } catch (const std::bad_alloc&) {
        return std::nullopt; // the work is taken off nevertheless
    }
}

} // namespace graftal
