#include "compiler/detail/weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/detail/baked.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/detail/shell/point_set.h"
#include "compiler/primitives/tessellate.h"

namespace graftal {

namespace {

/// Weight of endless detail: parts under a node with a plane never become small enough to end.
constexpr double boundless = std::numeric_limits<double>::infinity();
const Weights::Weight endless{boundless, boundless, boundless, boundless};
/// Least limit of kinds, in edges of the graph; and the factor by which the steps of details get coarser
/// where there are too many kinds.
constexpr std::uint64_t visits_an_edge = 2;
/// Visits after which the control is asked: some milliseconds.
constexpr std::uint64_t visits_a_look = 20'000;
constexpr int coarser_grain = 4;
/// Details beyond this are not told apart.
constexpr std::int32_t largest_step = 1 << 24;

/// A shell of this many octaves has most_shell_cells, about; larger ones are coarser.
constexpr int whole_octaves = 11;
/// Shells that a ray may go through, where a node is too large for one.
constexpr double most_shells_a_ray = 64;
/// Dimension above which a shell is never parted: one coarser shell is better than many shells of parts.
constexpr double most_parted_dimension = 4;
/// Where leaves are counted to know how fast they multiply: far apart, since equal maps multiply them by
/// leaps.
constexpr int few_octaves = 5, many_octaves = 13;

} // namespace

Weights::Weights(const DetailGraph& cut, const WeightOptions& options, const Control& control)
    : cut_(cut), options_(options), meter_(control, "weights", visits_a_look), grain_(options.grain) {
    // A proxy's mesh is an octahedron.
    proxy_ = {8, 1, 0, price(PrimitiveKind::sphere)};
    diameter_step_.reserve(cut.nodes.size());
    cut_step_.reserve(cut.nodes.size());
    for (const DetailNode& node : cut.nodes) {
        diameter_step_.push_back(PieceKind::steps_of(2 * node.ball.radius));
        cut_step_.push_back(PieceKind::steps_of(cut_detail(node, options.error_px)) + 1e-6);
        flat_.push_back(is_flat(node));
        edges_ += node.edges.size();
    }
}

double Weights::detail_step(const PieceKind& kind) const {
    if (kind.unit_step == PieceKind::tiny || kind.unit_step == PieceKind::endless_detail)
        return kind.unit_step;
    return kind.unit_step + diameter_step_[kind.node];
}

bool Weights::is_cut(const PieceKind& kind) const {
    return ends_by(cut_.nodes[kind.node], kind.steps, detail_step(kind) <= cut_step_[kind.node]);
}

PieceKind Weights::normalised(PieceKind kind) const {
    const DetailNode& node = cut_.nodes[kind.node];
    kind = without_idle_levels(cut_, kind);
    if (kind.unit_step == PieceKind::endless_detail || kind.unit_step == PieceKind::tiny) return kind;
    // To the nearest, so that what is counted level by level does not drift.
    if (grain_ > 1)
        kind.unit_step =
            static_cast<std::int32_t>(std::lround(static_cast<double>(kind.unit_step) / grain_)) * grain_;
    if (!node.primitive && detail_step(kind) <= 1e-6) {
        kind.unit_step = PieceKind::tiny;
    } else if (node.primitive || (!node.cullable && !node.unending)) {
        // The size decides how finely curved surfaces are meshed, and that grows slowly: few kinds suffice.
        const int octave = PieceKind::steps_an_octave;
        const double rounded = std::round(static_cast<double>(kind.unit_step) / octave) * octave;
        kind.unit_step = options_.px > 0 ? static_cast<std::int32_t>(rounded) : 0;
    }
    return kind;
}

std::int32_t Weights::mesh_bin(const PieceKind& kind) {
    constexpr std::int32_t first_of_shells = 1 << 20; // whose octaves are those of sizes
    const Weight weight = of(kind);
    if (weight.crowded)
        return first_of_shells +
               static_cast<std::int32_t>(std::lround(detail_step(kind) / PieceKind::steps_an_octave));
    return static_cast<std::int32_t>(std::lround(std::log2(std::clamp(weight.leaves, 1.0, 1e300))));
}

PieceKind Weights::child_kind(const PieceKind& parent, const DetailEdge& edge) const {
    PieceKind kind{edge.child, steps_below(parent.steps, edge), parent.unit_step};
    if (kind.unit_step != PieceKind::endless_detail && kind.unit_step != PieceKind::tiny) {
        // Products of stretches end only if every edge contracts; volumes always do.
        const double change = PieceKind::steps_of(cut_.contractive ? edge.stretch : edge.volume_stretch);
        // Rounded up, so that what is counted is never less than what is unfolded.
        const double step = kind.unit_step + std::ceil(change - 1e-6);
        kind.unit_step = static_cast<std::int32_t>(std::clamp<double>(step, -largest_step, largest_step));
    }
    return normalised(kind);
}

Weights::Weight Weights::of_primitive(const PieceKind& asked) const {
    const Primitive& primitive = *cut_.nodes[asked.node].primitive;
    if (primitive == PrimitiveKind::cube) return {options_.cube_triangles, 1, 0, price(primitive)};
    const double unit = static_cast<double>(asked.unit_step) / PieceKind::steps_an_octave;
    const double px = asked.unit_step == PieceKind::endless_detail ? 0 : options_.px * std::exp2(unit);
    const int level = px > 0 ? fineness_for(primitive, tessellation_tolerance(options_.px) / px) : 0;
    const TessellatedPrimitive& mesh = tessellated(primitive, level);
    return {static_cast<double>(mesh.triangles.size()), 1, mesh.normals.empty() ? 0.0 : 1.0,
            price(primitive)};
}

/// Weight of a cell that is not cut. Cells are many, and hardly any is met twice: it is faster to weigh them
/// than to remember them.
Weights::Weight Weights::of_cell(const PieceKind& kind, const EdgeCell& cell) {
    Weight sum;
    for (const EdgeCell::Alike& alike : cell.alike) {
        DetailEdge edge;
        edge.child = cell.source->child[alike.shape.index()];
        edge.stretch = edge.volume_stretch = std::exp2(0.25 * (alike.quarter_octave + 0.5));
        sum += alike.count * of_primitive(child_kind(kind, edge));
    }
    visits_ += cell.alike.size();
    crowd(kind, sum);
    return sum;
}

/// Counts only different leaves under a singular map. Along a line or in a plane there are about as many as
/// it has lengths or squares of half the error (least_width.h, speck_mark()).
void Weights::squeeze(const PieceKind& kind, Weight& weight) const {
    constexpr double leaves_an_error = 4; // in two sizes, halves of the error apart
    constexpr double fewest_lengths = 8;
    if (kind.unit_step == PieceKind::endless_detail || kind.unit_step == PieceKind::tiny) return;
    const double lengths =
        std::max(fewest_lengths, std::exp2(detail_step(kind) / PieceKind::steps_an_octave));
    const Vec3 sigma = singular_values(cut_.nodes[kind.node].edges.front().node_from_child.linear);
    const bool line = sigma.y <= 1e-9 * sigma.x;
    const double most = leaves_an_error * lengths * (line ? 1 : lengths);
    if (!(weight.leaves > most)) return;
    const double share = most / weight.leaves;
    for (double* const sum : {&weight.triangles, &weight.leaves, &weight.curved_leaves, &weight.flat_bytes})
        *sum = std::isfinite(*sum) ? share * *sum : most * 8;
}

/// A shell has as many triangles as its cells have faces outside.
void Weights::crowd(const PieceKind& kind, Weight& weight) const {
    if (kind.unit_step == PieceKind::endless_detail || kind.unit_step == PieceKind::tiny) return;
    const DetailNode& node = cut_.nodes[kind.node];
    if (node.sealed) weight.crowded = false; // crushed parts are baked as leaves
    if (node.primitive || node.unbounded || node.sealed) return;
    const double detail = std::exp2(detail_step(kind) / PieceKind::steps_an_octave);
    if (!is_crowded(weight.leaves, detail, flat_[kind.node])) return;
    constexpr double triangles_a_sheet_cell = 1, triangles_a_face_cell = 6;
    const double cells = std::min(detail * detail, most_shell_cells);
    weight.crowded = true;
    weight.triangles = std::min(weight.triangles,
                                (flat_[kind.node] ? triangles_a_sheet_cell : triangles_a_face_cell) * cells);
}

ShellSizes Weights::shell_sizes(NodeId node, std::uint32_t steps) {
    const PieceKind whole = normalised({node, steps, 0});
    const auto [place, added] = shell_sizes_.try_emplace({node, whole.steps});
    if (!added) return place->second;
    const double diameter = 2 * cut_.nodes[node].ball.radius;
    if (!(diameter > 0) || cut_.nodes[node].unbounded || cut_.nodes[node].sealed) return {};
    const auto leaves = [&](int octave) {
        return of({node, whole.steps, PieceKind::step_of(std::exp2(octave) / diameter)}).leaves;
    };
    const auto crowded = [&](int octave) {
        return is_crowded(leaves(octave), std::exp2(octave), flat_[node]);
    };
    ShellSizes sizes;
    const double all_leaves = leaves(many_octaves);
    for (int octave = 1; octave < whole_octaves && is_crowded(all_leaves, std::exp2(octave), flat_[node]);
         ++octave)
        if (crowded(octave)) sizes.octaves |= 1u << octave;
    if (crowded(many_octaves)) {
        const double dimension = std::log2(all_leaves / leaves(few_octaves)) / (many_octaves - few_octaves);
        // A square of a picture shows (size ratio)^dimension parts on (size ratio)^2 of its places.
        const double ratio = dimension < most_parted_dimension
                                 ? std::pow(most_shells_a_ray, 1 / std::max(dimension - 2, 1e-2))
                                 : 1;
        sizes.parted = std::exp2(whole_octaves) * ratio;
    }
    shell_sizes_[{node, whole.steps}] = sizes;
    return sizes;
}

bool Weights::is_shell(const PieceKind& kind) {
    const DetailNode& node = cut_.nodes[kind.node];
    if (node.primitive || node.unbounded || kind.unit_step == PieceKind::endless_detail ||
        kind.unit_step == PieceKind::tiny)
        return false;
    if (!of(kind).crowded) return false;
    return shell_sizes(kind.node, kind.steps).has(std::exp2(detail_step(kind) / PieceKind::steps_an_octave));
}

Weights::Weight& Weights::Weight::operator+=(const Weight& other) {
    triangles += other.triangles;
    leaves += other.leaves;
    curved_leaves += other.curved_leaves;
    flat_bytes += other.flat_bytes;
    crowded = crowded || other.crowded;
    return *this;
}

Weights::Weight Weights::of(const PieceKind& asked) {
    for (;;) {
        const std::size_t before = known_.size();
        const std::uint32_t start = number_of(normalised(asked));
        if (known_.size() == before || weigh(start)) return known_[start].weight;
        forget_kinds();
    }
}

/// Until it is weighed a new kind counts as a proxy, or as no end of them.
std::uint32_t Weights::number_of(const PieceKind& kind) {
    const auto next = static_cast<std::uint32_t>(known_.size());
    const std::uint32_t number = numbers_.find_or_add(
        PieceKindHash()(kind), next, [&](std::uint32_t other) { return known_[other].kind == kind; });
    if (number == next)
        known_.push_back({kind, kind.unit_step == PieceKind::endless_detail ? endless : proxy_});
    return number;
}

/// False if there are too many kinds under it.
bool Weights::weigh(std::uint32_t start) {
    stack_.assign(1, {start, 0, {}});
    while (!stack_.empty()) {
        Frame& frame = stack_.back();
        const PieceKind kind = known_[frame.number].kind;
        const DetailNode& node = cut_.nodes[kind.node];
        const bool cut = is_cut(kind);
        const auto& edges = followed_edges(node, cut);
        if (node.cell && !cut) frame.sum = of_cell(kind, *node.cell);
        if (frame.next_edge < edges.size()) {
            const PieceKind next = child_kind(kind, edges[frame.next_edge++]);
            ++visits_;
            meter_.add();
            if (const EdgeCell* const cell = cut_.nodes[next.node].cell.get(); cell && !is_cut(next)) {
                frame.sum += of_cell(next, *cell);
                continue;
            }
            const std::size_t before = known_.size();
            const std::uint32_t child = number_of(next);
            if (known_.size() == before) {
                frame.sum += known_[child].weight;
            } else {
                if (too_many_kinds()) return false;
                stack_.push_back({child, 0, {}});
            }
            continue;
        }
        if (node.primitive && *node.primitive != PrimitiveKind::plane)
            frame.sum = of_primitive(kind);
        else if (edges.empty() && (!node.cell || cut))
            frame.sum = proxy_;
        if (node.sealed) squeeze(kind, frame.sum);
        if (!node.cell || cut) crowd(kind, frame.sum);
        const Weight sum = known_[frame.number].weight = frame.sum;
        stack_.pop_back();
        if (!stack_.empty()) stack_.back().sum += sum;
    }
    return true;
}

bool Weights::too_many_kinds() const {
    return visits_ - visits_before_ > std::max(options_.most_visits, visits_an_edge * edges_) &&
           grain_ <= PieceKind::steps_an_octave;
}

void Weights::forget_kinds() {
    known_.clear();
    numbers_.clear();
    visits_before_ = visits_;
    grain_ *= coarser_grain;
}

} // namespace graftal
