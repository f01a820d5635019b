#include "runtime/graftal/listed_graph.h"

#include <map>
#include <string>

#include <fmt/format.h>

namespace graftal::v1 {

namespace {

constexpr std::size_t most_instances = 10'000'000;

class Lister {
  public:
    explicit Lister(const graftal::Graph& graph) : graph_(graph) {
        listed_.root = graph.root;
        for (const Object& object : graph.objects)
            add_object(object.name, object.primitive ? name_of(*object.primitive) : std::string());
    }

    ObjectGraph list() {
        for (std::size_t parent = 0; parent < graph_.objects.size(); ++parent) {
            const Object& object = graph_.objects[parent];
            for (const Instance& instance : object.instances)
                add(parent, instance.master, instance.parent_from_child, instance.tint);
            for (const PackedEdge& edge : object.packed)
                add(parent, round_object(edge.primitive), edge.parent_from_child, {});
        }
        return std::move(listed_);
    }

  private:
    std::size_t add_object(const std::string& name, const std::string& primitive) {
        listed_.objects.push_back(name);
        listed_.primitives.push_back(primitive);
        return listed_.objects.size() - 1;
    }

    void add(std::size_t parent, std::size_t child, const Affine& map, const Tint& tint) {
        GraphInstance instance{parent, child, {}, {tint.rgb[0], tint.rgb[1], tint.rgb[2], tint.alpha}};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                instance.parent_from_child[4 * row + column] = map.linear[column][row];
            instance.parent_from_child[4 * row + 3] = map.translation[row];
        }
        listed_.instances.push_back(instance);
    }

    /// The object for a primitive, which packed edges name by its kind.
    std::size_t round_object(const Primitive& primitive) {
        const std::string& name = name_of(primitive);
        const auto known = round_objects_.find(name);
        if (known != round_objects_.end()) return known->second;
        return round_objects_[name] = add_object(name, name);
    }

    const graftal::Graph& graph_;
    ObjectGraph listed_;
    std::map<std::string, std::size_t> round_objects_;
};

} // namespace

std::optional<ObjectGraph> listed_graph(const graftal::Graph& graph, Status& status) {
    const std::size_t count = edge_count(graph);
    if (count <= most_instances) return Lister(graph).list();
    status = Status::failure(
        fmt::format("the graph has {} instances: it can be listed with at most {}", count, most_instances));
    return std::nullopt;
}

} // namespace graftal::v1
