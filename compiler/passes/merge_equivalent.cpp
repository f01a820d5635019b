#include "compiler/passes/merge_equivalent.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/graph/attributes.h"
#include "compiler/passes/rewrite.h"
#include "compiler/support/id_table.h"

namespace graftal {

namespace {

/// Number of an instance's placement of its master; equal placements share it.
using Label = std::uint32_t;

/// All of an instance but its master.
using Placement = AttributeWords;

std::uint64_t hash_of(const Placement& placement) {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : placement.words())
        hash = mixed(hash, word);
    return hash;
}

/// The sum of the chances that an object's instances state, which they are relative to; 0: none are stated.
double chance_sum(const Object& object) {
    double sum = 0;
    for (const Instance& instance : object.instances)
        sum += instance.chance;
    return sum;
}

/// Share of a chance in a sum; rounded, since the chances of equal objects may come by different ways.
double chance_share(double chance, double sum) {
    constexpr double digits = 1e12;
    return sum > 0 && std::isfinite(sum) ? std::round(chance / sum * digits) / digits : chance;
}

/// `terminal_px`: nothing but of a terminal; `chance`: relative to all of the object.
Placement placement_of(Instance instance, std::optional<double> terminal_px, double chance,
                       std::uint64_t role) {
    instance.chance = chance;
    Placement placement = attribute_words(instance);
    placement.put(std::uint64_t{terminal_px.has_value()});
    placement.put(terminal_px.value_or(0));
    placement.put(role);
    return placement;
}

/// The part that an instance takes in the combination of its object.
std::uint64_t role_of(const Object& object, const Instance& instance) {
    const bool first = object.combination == Combination::subtract && &instance == &object.instances.front();
    return 2 * static_cast<std::uint64_t>(object.combination) + (first ? 1 : 0);
}

/// Placement of the shape alone.
Placement place_of(const Instance& instance, std::uint64_t role) {
    const Affine& map = instance.parent_from_child;
    Placement placement;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            placement.put(map.linear[column][row]);
    for (int row = 0; row < 3; ++row)
        placement.put(map.translation[row]);
    placement.put(role);
    return placement;
}

class Labels {
  public:
    Label of(const Placement& placement) {
        const auto next = static_cast<Label>(known_.size());
        const Label label = ids_.find_or_add(hash_of(placement), next,
                                             [&](Label known) { return known_[known] == placement; });
        if (label == next) known_.push_back(placement);
        return label;
    }

  private:
    std::vector<Placement> known_; ///< by label
    IdTable ids_;
};

/// The graph as labelled edges, terminals included, to be read against their direction.
struct Edges {
    struct Arrival {
        ObjectId user;
        Label label;
        auto operator<=>(const Arrival&) const = default;
    };

    std::vector<std::vector<Label>> labels_of; ///< by object: of its instances and terminal, sorted
    std::vector<std::size_t> first_arrival;    ///< by object, and one past the last
    std::vector<Arrival> arrivals;             ///< by master

    std::span<const Arrival> into(ObjectId master) const {
        return std::span(arrivals).subspan(first_arrival[master],
                                           first_arrival[master + 1] - first_arrival[master]);
    }
};

/// Properties that objects must have in common to be equal.
enum class Alike {
    in_all,  ///< all that they unfold to
    in_shape ///< the place of that: not colours, materials, terminals or chances
};

Edges edges_of(const Graph& graph, Alike alike) {
    Edges edges;
    edges.labels_of.resize(graph.objects.size());
    edges.first_arrival.assign(graph.objects.size() + 1, 0);
    Labels labels;
    for (ObjectId user = 0; user < graph.objects.size(); ++user) {
        const Object& object = graph.objects[user];
        const double chances = chance_sum(object);
        for (const Instance& instance : object.instances) {
            edges.labels_of[user].push_back(
                labels.of(alike == Alike::in_shape
                              ? place_of(instance, role_of(object, instance))
                              : placement_of(instance, std::nullopt, chance_share(instance.chance, chances),
                                             role_of(object, instance))));
            ++edges.first_arrival[instance.master + 1];
        }
        if (object.terminal && alike == Alike::in_all) {
            edges.labels_of[user].push_back(
                labels.of(placement_of(*object.terminal, object.terminal_px, 0, 0)));
            ++edges.first_arrival[object.terminal->master + 1];
        }
    }
    std::partial_sum(edges.first_arrival.begin(), edges.first_arrival.end(), edges.first_arrival.begin());

    edges.arrivals.resize(edges.first_arrival.back());
    std::vector<std::size_t> next(edges.first_arrival.begin(), edges.first_arrival.end() - 1);
    for (ObjectId user = 0; user < graph.objects.size(); ++user) {
        const Object& object = graph.objects[user];
        std::vector<Label>& own = edges.labels_of[user];
        for (std::size_t i = 0; i < object.instances.size(); ++i)
            edges.arrivals[next[object.instances[i].master]++] = {user, own[i]};
        if (object.terminal && alike == Alike::in_all)
            edges.arrivals[next[object.terminal->master]++] = {user, own.back()};
        std::sort(own.begin(), own.end());
    }
    return edges;
}

using BlockId = std::uint32_t;

/// A partition of the objects, each block a contiguous range of `elements_`.
class Partition {
  public:
    /// One block of everything.
    explicit Partition(std::size_t size) : elements_(size), position_(size), block_of_(size, 0) {
        std::iota(elements_.begin(), elements_.end(), 0u);
        std::iota(position_.begin(), position_.end(), 0u);
        blocks_.push_back({0, static_cast<std::uint32_t>(size)});
    }

    BlockId block_of(ObjectId object) const { return block_of_[object]; }
    std::size_t block_count() const { return blocks_.size(); }
    std::size_t size(BlockId block) const { return blocks_[block].end - blocks_[block].begin; }
    std::span<const ObjectId> members(BlockId block) const {
        return std::span(elements_).subspan(blocks_[block].begin, size(block));
    }

    /// Makes a block of its own out of some members of one block. O(members moved).
    BlockId carve(std::span<const ObjectId> members) {
        const auto fresh = static_cast<BlockId>(blocks_.size());
        Block& old = blocks_[block_of_[members.front()]];
        const std::uint32_t end = old.end;
        for (const ObjectId object : members) {
            const ObjectId other = elements_[--old.end];
            std::swap(elements_[position_[object]], elements_[old.end]);
            std::swap(position_[object], position_[other]);
            block_of_[object] = fresh;
        }
        blocks_.push_back({old.end, end}); // invalidates `old`
        return fresh;
    }

  private:
    struct Block {
        std::uint32_t begin, end;
    };
    std::vector<ObjectId> elements_;
    std::vector<std::uint32_t> position_;
    std::vector<BlockId> block_of_;
    std::vector<Block> blocks_;
};

/// Finds the coarsest partition in which the objects of a block have the same labels into every block.
///
/// A block that has been split is a splitter again by all its parts but one, the largest: how often an object
/// leads into that part follows from the others and from the whole, with which the partition agreed. So an
/// edge is looked at again only when its master lies in a block of at most half the size: O(E log V) visits.
class Refinement {
  public:
    Refinement(const Graph& graph, Alike alike)
        : edges_(edges_of(graph, alike)), partition_(graph.objects.size()) {
        split_by_own_labels(graph, alike);
        for (BlockId block = 0; block < partition_.block_count(); ++block)
            enqueue(block);
    }

    Partition run() && {
        while (!queue_.empty()) {
            const BlockId splitter = queue_.back();
            queue_.pop_back();
            queued_[splitter] = false;
            split_by(splitter);
        }
        return std::move(partition_);
    }

  private:
    /// An object that leads into the splitter, by the arrivals [first, last).
    struct User {
        BlockId block;
        ObjectId object;
        std::span<const Edges::Arrival> arrivals;
    };

    void split_by_own_labels(const Graph& graph, Alike alike) {
        std::vector<ObjectId> order(graph.objects.size());
        std::iota(order.begin(), order.end(), 0u);
        const bool coloured = alike == Alike::in_all;
        const auto same_kind = [&](ObjectId a, ObjectId b) {
            return graph.objects[a].primitive == graph.objects[b].primitive &&
                   graph.objects[a].packed.run == graph.objects[b].packed.run &&
                   (!coloured || graph.objects[a].packed.materials == graph.objects[b].packed.materials) &&
                   edges_.labels_of[a] == edges_.labels_of[b];
        };
        std::sort(order.begin(), order.end(), [&](ObjectId a, ObjectId b) {
            if (graph.objects[a].primitive != graph.objects[b].primitive)
                return graph.objects[a].primitive < graph.objects[b].primitive;
            const PackedEdges &x = graph.objects[a].packed, &y = graph.objects[b].packed;
            // Whichever comes first, the blocks are the same.
            if (x.run != y.run) return std::less<>()(x.run.get(), y.run.get());
            if (coloured && x.materials != y.materials) return x.materials < y.materials;
            if (edges_.labels_of[a] != edges_.labels_of[b]) return edges_.labels_of[a] < edges_.labels_of[b];
            return a < b;
        });
        for (auto first = order.begin(); first != order.end();) {
            const auto end =
                std::find_if(first, order.end(), [&](ObjectId id) { return !same_kind(*first, id); });
            if (first != order.begin()) partition_.carve({first, end});
            first = end;
        }
    }

    void split_by(BlockId splitter) {
        arrivals_.clear();
        for (const ObjectId master : partition_.members(splitter)) {
            const auto into = edges_.into(master);
            arrivals_.insert(arrivals_.end(), into.begin(), into.end());
        }
        std::sort(arrivals_.begin(), arrivals_.end());

        users_.clear();
        for (auto first = arrivals_.begin(); first != arrivals_.end();) {
            const auto end =
                std::find_if(first, arrivals_.end(), [&](const auto& a) { return a.user != first->user; });
            users_.push_back({partition_.block_of(first->user), first->user, {first, end}});
            first = end;
        }
        std::sort(users_.begin(), users_.end(), [](const User& a, const User& b) {
            if (a.block != b.block) return a.block < b.block;
            const auto order = compare_labels(a, b);
            return order != 0 ? order < 0 : a.object < b.object;
        });
        for (auto first = users_.begin(); first != users_.end();) {
            const auto end = std::find_if(first, users_.end(),
                                          [&](const User& user) { return user.block != first->block; });
            split_block({first, end});
            first = end;
        }
    }

    static std::strong_ordering compare_labels(const User& a, const User& b) {
        return std::lexicographical_compare_three_way(
            a.arrivals.begin(), a.arrivals.end(), b.arrivals.begin(), b.arrivals.end(),
            [](const Edges::Arrival& x, const Edges::Arrival& y) { return x.label <=> y.label; });
    }

    /// Splits one block by what its users of the splitter (all of them, sorted) have into it; the objects
    /// that are no users keep the block's number, or else the last kind of user does.
    void split_block(std::span<const User> users) {
        const BlockId block = users.front().block;
        parts_.assign(1, block);
        while (!users.empty()) {
            const auto end = std::find_if(users.begin(), users.end(), [&](const User& user) {
                return compare_labels(users.front(), user) != 0;
            });
            const auto count = static_cast<std::size_t>(end - users.begin());
            if (count == partition_.size(block)) break; // nobody else is left in it
            part_members_.clear();
            for (const User& user : users.first(count))
                part_members_.push_back(user.object);
            parts_.push_back(partition_.carve(part_members_));
            users = users.subspan(count);
        }
        queued_.resize(partition_.block_count(), false);
        const auto smaller = [&](BlockId a, BlockId b) { return partition_.size(a) < partition_.size(b); };
        const BlockId spared =
            queued_[block] ? block : *std::max_element(parts_.begin(), parts_.end(), smaller);
        for (const BlockId part : parts_)
            if (part != spared) enqueue(part);
    }

    void enqueue(BlockId block) {
        queued_.resize(partition_.block_count(), false);
        queued_[block] = true;
        queue_.push_back(block);
    }

    const Edges edges_;
    Partition partition_;
    std::vector<BlockId> queue_;
    std::vector<bool> queued_; // by block
    // Scratch space of split_by, kept between calls.
    std::vector<Edges::Arrival> arrivals_;
    std::vector<User> users_;
    std::vector<BlockId> parts_;
    std::vector<ObjectId> part_members_;
};

} // namespace

Rewritten merge_equivalent(Graph graph) {
    const Partition partition = Refinement(graph, Alike::in_all).run();
    std::vector<ObjectId> first_of(partition.block_count());
    std::vector<bool> keep(graph.objects.size(), false);
    for (BlockId block = 0; block < partition.block_count(); ++block) {
        const std::span<const ObjectId> members = partition.members(block);
        first_of[block] = *std::min_element(members.begin(), members.end());
        keep[first_of[block]] = true;
    }
    const std::vector<std::uint32_t> of_kept = compact(graph.objects, keep);
    Renumbering renumbering;
    renumbering.now.reserve(of_kept.size());
    for (ObjectId object = 0; object < of_kept.size(); ++object)
        renumbering.now.push_back(of_kept[first_of[partition.block_of(object)]]);
    renumbering.origin = origins(renumbering.now, graph.objects.size());
    for_each_instance(graph, [&](Instance& instance) { instance.master = renumbering.now[instance.master]; });
    graph.root = renumbering.now[graph.root];
    return {std::move(graph), std::move(renumbering)};
}

ShapeClasses classes_of_shape(const Graph& graph) {
    const Partition partition = Refinement(graph, Alike::in_shape).run();
    constexpr std::uint32_t unseen = UINT32_MAX;
    std::vector<std::uint32_t> number(partition.block_count(), unseen);
    ShapeClasses classes;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        std::uint32_t& own = number[partition.block_of(id)];
        if (own == unseen) {
            own = static_cast<std::uint32_t>(classes.first.size());
            classes.first.push_back(id);
        }
        classes.class_of.push_back(own);
    }
    return classes;
}

} // namespace graftal
