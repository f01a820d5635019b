#include "compiler/analysis/support_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/analysis/run_bounds.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
    hash ^= value + 0x9e3779b97f4a7c15u + (hash << 6) + (hash >> 2);
    return hash * 0xff51afd7ed558ccdu;
}

} // namespace

Support SupportSearch::run(ObjectId object, Vec3 direction, double tolerance, std::uint64_t most_pieces) {
    arena_.clear();
    heap_.clear();
    filled_ = mask_ = 0;
    ++run_;
    pieces_ = 0;
    tolerance_ = tolerance;
    best_ = discarded_ = nowhere;
    magnitude_ = 0;
    Piece root;
    root.direction = direction;
    root.object = object;
    arena_.push_back(root);
    expand(0);
    double open = nowhere;
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(),
                      [this](std::uint32_t a, std::uint32_t b) { return nearer(a, b); });
        const std::uint32_t top = heap_.back();
        heap_.pop_back();
        if (arena_[top].dominated) continue;
        if (arena_[top].upper <= best_ + tolerance_ || pieces_ >= most_pieces) {
            open = arena_[top].upper;
            break;
        }
        expand(top);
    }
    // Where all has overflown, nothing was reached.
    const Vec3 point = best_ > nowhere ? point_in_root(best_parent_, best_instance_, best_point_) : Vec3(0.0);
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * magnitude_;
    return {std::max({open, discarded_, best_}) + rounding, best_, point};
}

void SupportSearch::expand(std::uint32_t parent) {
    const Piece from = arena_[parent];
    const std::span<const Instance> instances = bounding_instances(graph_.objects[from.object]);
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        const Instance& instance = instances[i];
        const Outer& outer = outers_[instance.master];
        if (outer.empty) continue;
        ++pieces_;
        Piece piece;
        piece.object = instance.master;
        piece.parent = parent;
        piece.instance = i;
        piece.direction = from.direction * instance.parent_from_child.linear; // A^T d
        const Vec3 shift = from.direction * instance.parent_from_child.translation;
        piece.offset = from.offset + (shift.x + shift.y + shift.z);
        magnitude_ = std::max(magnitude_, std::abs(from.offset) + std::abs(shift.x) + std::abs(shift.y) +
                                              std::abs(shift.z));
        const std::optional<Primitive>& primitive = graph_.objects[instance.master].primitive;
        const Vec3 point = primitive   ? traits_of(*primitive).support_point(*primitive, piece.direction)
                           : outer.run ? outer.run->support_point(piece.direction)
                                       : outer.farthest_point(piece.direction);
        const double reached = piece.offset + glm::dot(piece.direction, point);
        if (std::isnan(reached)) discarded_ = largest_length;
        if (reached > best_) {
            best_ = reached;
            best_parent_ = parent;
            best_instance_ = i;
            best_point_ = point;
        }
        if (primitive || outer.run) continue;
        if (graph_.objects[instance.master].combination == Combination::intersect) {
            discarded_ = std::max(discarded_, within_range(piece.offset + outer.above(piece.direction)));
            continue;
        }
        piece.upper = within_range(piece.offset + outer.above(piece.direction));
        if (piece.upper == largest_length) {
            // Out of range: nothing to be gained by looking closer.
            discarded_ = largest_length;
            continue;
        }
        piece.at_centre = piece.offset + glm::dot(piece.direction, outer.centre);
        if (piece.upper <= best_ + tolerance_)
            discarded_ = std::max(discarded_, piece.upper);
        else
            push(piece);
    }
}

void SupportSearch::push(const Piece& piece) {
    const auto number = static_cast<std::uint32_t>(arena_.size());
    if (!merge(piece, number)) return;
    arena_.push_back(piece);
    heap_.push_back(number);
    std::push_heap(heap_.begin(), heap_.end(),
                   [this](std::uint32_t a, std::uint32_t b) { return nearer(a, b); });
}

bool SupportSearch::merge(const Piece& piece, std::uint32_t number) {
    constexpr std::uint32_t worth_merging = 48;
    if (number < worth_merging) return true;
    const Key key = key_of(piece);
    const std::uint32_t hash = hash_of(key);
    Slot& slot = slot_for(key, hash);
    if (slot.run == run_) {
        if (arena_[slot.piece].at_centre >= piece.at_centre) return false;
        arena_[slot.piece].dominated = true;
    } else {
        slot.run = run_;
        slot.hash = hash;
        ++filled_;
    }
    slot.piece = number;
    return true;
}

SupportSearch::Key SupportSearch::key_of(const Piece& piece) {
    const Vec3 d = piece.direction;
    const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    Key key;
    key.object = piece.object;
    if (!(largest > 0) || !std::isfinite(largest)) return key;
    // Fixed point, 41 bits below the largest component; the exponent is read off the bits, which is fast.
    constexpr int kept_bits = 41, mantissa_bits = 52, bias = 1023;
    key.exponent = static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(largest) >> mantissa_bits) - bias;
    if (key.exponent <= kept_bits - bias) return Key{0, 0, 0, 0, piece.object}; // all but zero
    const auto scale =
        std::bit_cast<double>(static_cast<std::uint64_t>(kept_bits - key.exponent + bias) << mantissa_bits);
    const auto rounded = [scale](double x) {
        return static_cast<std::int64_t>(x * scale + std::copysign(0.5, x));
    };
    key.x = rounded(d.x);
    key.y = rounded(d.y);
    key.z = rounded(d.z);
    return key;
}

std::uint32_t SupportSearch::hash_of(const Key& key) {
    std::uint64_t hash = key.object;
    for (const std::int64_t part : {key.x, key.y, key.z, std::int64_t{key.exponent}})
        hash = mixed(hash, static_cast<std::uint64_t>(part));
    return static_cast<std::uint32_t>(hash ^ (hash >> 32));
}

SupportSearch::Slot& SupportSearch::slot_for(const Key& key, std::uint32_t hash) {
    if (2 * (filled_ + 1) > mask_ + 1) grow_table();
    std::size_t at = hash & mask_;
    while (table_[at].run == run_ && !(table_[at].hash == hash && key_of(arena_[table_[at].piece]) == key))
        at = (at + 1) & mask_;
    return table_[at];
}

void SupportSearch::grow_table() {
    constexpr std::size_t fewest_slots = 64;
    std::vector<Slot> kept;
    for (std::size_t i = 0; i <= mask_ && filled_ > 0; ++i)
        if (table_[i].run == run_) kept.push_back(std::exchange(table_[i], {}));
    mask_ = std::max(fewest_slots, 2 * (mask_ + 1)) - 1;
    if (table_.size() <= mask_) table_.resize(mask_ + 1);
    for (const Slot& slot : kept) {
        std::size_t at = slot.hash & mask_;
        while (table_[at].run == run_)
            at = (at + 1) & mask_;
        table_[at] = slot;
    }
}

Vec3 SupportSearch::point_in_root(std::uint32_t parent, std::uint32_t instance, Vec3 point) const {
    for (;;) {
        const Piece& piece = arena_[parent];
        point = graph_.objects[piece.object].instances[instance].parent_from_child(point);
        if (parent == 0) return point;
        instance = piece.instance;
        parent = piece.parent;
    }
}

} // namespace graftal
