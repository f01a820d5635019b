#include "compiler/graph/text/print_rifs.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/graph/attributes.h"
#include "compiler/graph/path.h"
#include "compiler/graph/primitive.h"
#include "compiler/graph/text/print.h"

namespace graftal {

namespace {

/// A primitive that is written out where it lies.
struct Part {
    std::string master;
    Instance placed;
};

/// Instances with one map and look, and what they place.
struct Group {
    Instance map;
    std::vector<ObjectId> masters;
};

/// One instance within another.
Instance within(const Instance& outer, const Instance& inner) {
    Instance result = inner;
    result.parent_from_child = outer.parent_from_child * inner.parent_from_child;
    const PathTint tint = PathTint(outer.tint) * PathTint(inner.tint);
    if (tint.alpha > 0) result.tint = straight(tint);
    if (!inner.material) result.material = outer.material;
    return result;
}

bool alike(const Affine& a, const Affine& b) {
    constexpr double rounding = 1e-9;
    const double size = largest_entry(a.linear) + largest_entry(a.translation);
    return largest_entry(a.linear - b.linear) + largest_entry(a.translation - b.translation) <=
           rounding * size;
}

bool alike(const std::vector<Part>& a, const std::vector<Part>& b) {
    return std::ranges::equal(a, b, [](const Part& x, const Part& y) {
        return x.master == y.master && x.placed.tint == y.placed.tint &&
               x.placed.material == y.placed.material &&
               alike(x.placed.parent_from_child, y.placed.parent_from_child);
    });
}

class RifsPrinter {
  public:
    RifsPrinter(const Graph& graph, const Components& components)
        : graph_(graph), components_(components), name_of_(graph.objects.size()) {}

    std::optional<std::string> run(std::string& why) {
        if (!components_.unending[graph_.root]) {
            why = "nothing in it contains itself";
            return std::nullopt;
        }
        if (const ObjectId id = first_combined(graph_); id < graph_.objects.size()) {
            why = fmt::format("'{}' is no union of its parts", graph_.objects[id].name);
            return std::nullopt;
        }
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (components_.unending[id]) objects_.push_back(id);
        out_ = print_scenery(graph_);
        if (!print_one_block())
            for (const ObjectId id : objects_)
                print_block(id);
        if (why_.empty()) return std::move(out_);
        why = why_;
        return std::nullopt;
    }

  private:
    /// A name that no other map or block has.
    std::string fresh_name(const std::string& wanted) {
        std::string stem;
        for (const char c : wanted)
            stem += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
        if (stem.empty() || !std::isalpha(static_cast<unsigned char>(stem.front()))) stem.insert(0, "m");
        if (primitive_kind_named(stem)) stem += "_set";
        std::string name = stem;
        for (int number = 2; !names_.insert(name).second; ++number)
            name = fmt::format("{}_{}", stem, number);
        return name;
    }

    const std::string& block_name(ObjectId id) {
        std::string& name = name_of_[id];
        if (name.empty()) name = fresh_name(graph_.objects[id].name);
        return name;
    }

    std::vector<Group> groups_of(ObjectId id) const {
        std::vector<Group> groups;
        for (const Instance& instance : graph_.objects[id].instances) {
            if (!components_.unending[instance.master]) continue;
            const auto found = std::ranges::find_if(groups, [&](const Group& group) {
                return group.map.parent_from_child == instance.parent_from_child &&
                       group.map.tint == instance.tint && group.map.material == instance.material;
            });
            if (found != groups.end())
                found->masters.push_back(instance.master);
            else
                groups.push_back({instance, {instance.master}});
        }
        return groups;
    }

    void add_part(const Primitive& primitive, const std::string& name, const Instance& placed,
                  std::vector<Part>& parts) {
        if (++part_count_ > most_printed_parts)
            why_ = fmt::format("its parts that end are more than {}, written out", most_printed_parts);
        else if (primitive.kind() == PrimitiveKind::mesh)
            why_ = "a mesh of a file is no part of one";
        else
            parts.push_back({name, placed});
    }

    /// The primitives of something that ends.
    void add_ending(const Instance& placed, std::vector<Part>& parts) {
        if (!why_.empty()) return;
        const Object& object = graph_.objects[placed.master];
        if (object.primitive) return add_part(*object.primitive, object.name, placed, parts);
        for (const Instance& instance : object.instances)
            add_ending(within(placed, instance), parts);
        for (const PackedEdge& edge : object.packed)
            add_part(edge.primitive, std::string(name_of(edge.primitive)),
                     within(placed, {0, edge.parent_from_child, Tint(), edge.material, Span()}), parts);
    }

    std::vector<Part> condensation_of(ObjectId id) {
        std::vector<Part> parts;
        for (const Instance& instance : graph_.objects[id].instances)
            if (!components_.unending[instance.master]) add_ending(instance, parts);
        return parts;
    }

    std::vector<Part> terminal_of(ObjectId id) {
        std::vector<Part> parts;
        if (const std::optional<Instance>& terminal = graph_.objects[id].terminal)
            add_ending(*terminal, parts);
        if (parts.size() > 1)
            why_ = fmt::format("the terminal of '{}' has {} shapes, and a block takes one",
                               graph_.objects[id].name, parts.size());
        return parts;
    }

    std::string attributes(const Instance& instance) const {
        Instance written = instance;
        written.chance = 0;
        written.levels = levels_of_master;
        std::string text;
        for (const Attribute& attribute : instance_attributes())
            text += attribute.text(graph_, written);
        return text;
    }

    void print_part(std::string_view keyword, const Part& part, double below_px = 0) {
        out_ += fmt::format("  {} {}\n{}", keyword, part.master, attributes(part.placed));
        if (below_px > 0) out_ += fmt::format("    below: {}\n", below_px);
    }

    void print_parts(const std::vector<Part>& condensation, const std::vector<Part>& terminal,
                     double below_px) {
        for (const Part& part : condensation)
            print_part("condense", part);
        for (const Part& part : terminal)
            print_part("terminal", part, below_px);
    }

    void open_block(ObjectId id) {
        out_ += fmt::format("{}rifs {} {{\n", id == graph_.root ? "main " : "", block_name(id));
    }

    void print_map(const std::string& name, const Instance& map, const std::string& from) {
        out_ += fmt::format("  map {}{}{} {{\n{}  }}\n", name, from.empty() ? "" : " from ", from,
                            attributes(map));
    }

    /// The set of an object as a block: its maps take the blocks of others.
    void print_block(ObjectId id) {
        open_block(id);
        int number = 0;
        for (const Instance& instance : graph_.objects[id].instances)
            if (components_.unending[instance.master])
                print_map(fmt::format("m{}", ++number), instance, block_name(instance.master));
        print_parts(condensation_of(id), terminal_of(id), graph_.objects[id].terminal_px);
        out_ += "}\n\n";
    }

    /// Parts of an object as they lie before its map.
    std::vector<Part> before(const Affine& map, std::vector<Part> parts) const {
        const Affine back = inverse(map);
        for (Part& part : parts)
            part.placed.parent_from_child = back * part.placed.parent_from_child;
        return parts;
    }

    /// One block, where each set is the image of the same condensation set and of others under one map. The
    /// sets of a model in `.rifs` are such, and those of graphs that have maps only.
    bool print_one_block() {
        struct Map {
            std::string name;
            Instance map;
            std::vector<ObjectId> masters;
        };
        const std::vector<Part> condensation = condensation_of(graph_.root),
                                terminal = terminal_of(graph_.root);
        const double below_px = graph_.objects[graph_.root].terminal_px;
        std::vector<Map> maps;
        std::vector<std::vector<std::size_t>> maps_of(graph_.objects.size());
        for (const ObjectId id : objects_) {
            std::vector<Group> groups = groups_of(id);
            const bool root = id == graph_.root;
            const bool bare = condensation_of(id).empty() && terminal_of(id).empty();
            if (root && groups.size() == 1 && groups.front().map.parent_from_child == Affine() &&
                groups.front().map.tint == Tint() && !groups.front().map.material) {
                start_ = groups.front().masters;
                continue;
            }
            const bool plain = condensation.empty() && terminal.empty() && bare;
            if (!plain) {
                // Its map stands before its parts, too.
                if (root || groups.size() != 1 || is_singular(groups.front().map.parent_from_child))
                    return false;
                const Group& group = groups.front();
                const auto taken_back = [&](std::vector<Part> parts) {
                    for (Part& part : parts) {
                        if (part.placed.tint == group.map.tint) part.placed.tint = Tint();
                        if (part.placed.material == group.map.material) part.placed.material.reset();
                    }
                    return before(group.map.parent_from_child, std::move(parts));
                };
                if (!alike(taken_back(condensation_of(id)), condensation) ||
                    !alike(taken_back(terminal_of(id)), terminal) ||
                    graph_.objects[id].terminal_px != below_px)
                    return false;
            }
            int number = 0;
            for (Group& group : groups) {
                const std::string& own = graph_.objects[id].name;
                maps_of[id].push_back(maps.size());
                maps.push_back({fresh_name(groups.size() == 1 ? own : fmt::format("{}_{}", own, ++number)),
                                group.map, std::move(group.masters)});
            }
        }
        if (start_.empty()) start_ = {graph_.root};
        open_block(graph_.root);
        for (const Map& map : maps)
            print_map(map.name, map.map, "");
        const auto names_of = [&](const std::vector<ObjectId>& masters) {
            std::vector<std::string> names;
            for (const ObjectId master : masters)
                for (const std::size_t map : maps_of[master])
                    names.push_back(maps[map].name);
            return names;
        };
        // Hart's edge i -> j: the map j follows the map i.
        std::vector<std::string> followers(maps.size());
        bool all = true;
        for (const Map& map : maps) {
            std::size_t masters = 0;
            for (const ObjectId master : map.masters)
                for (const std::size_t before_it : maps_of[master]) {
                    followers[before_it] += (followers[before_it].empty() ? "" : ", ") + map.name;
                    ++masters;
                }
            all = all && masters == maps.size();
        }
        if (!all) {
            out_ += "  follow {\n";
            for (std::size_t i = 0; i < maps.size(); ++i)
                if (!followers[i].empty()) out_ += fmt::format("    {} -> {}\n", maps[i].name, followers[i]);
            out_ += "  }\n";
        }
        const std::vector<std::string> first = names_of(start_);
        if (first.size() < maps.size()) out_ += fmt::format("  start {}\n", fmt::join(first, ", "));
        print_parts(condensation, terminal, below_px);
        out_ += "}\n";
        return true;
    }

    const Graph& graph_;
    const Components& components_;
    std::vector<ObjectId> objects_; ///< that contain themselves, or lead to one that does
    std::vector<ObjectId> start_;
    std::vector<std::string> name_of_;
    std::set<std::string> names_;
    std::size_t part_count_ = 0;
    std::string why_, out_;
};

} // namespace

std::optional<std::string> print_rifs(const Graph& graph, const Components& components, std::string& why) {
    return RifsPrinter(graph, components).run(why);
}

} // namespace graftal
