#include "compiler/graph/graph.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "compiler/graph/attributes.h"

namespace graftal {

namespace {

using ObjectsByName = std::unordered_map<std::string_view, const Object*>;

ObjectsByName by_name(const Graph& graph) {
    ObjectsByName objects;
    for (const Object& object : graph.objects)
        objects.emplace(object.name, &object);
    return objects;
}

/// An edge by its master's name.
struct NamedEdge {
    std::string_view master;
    Instance instance; ///< apart from its master
};

/// The edges of an object, and its terminal.
std::vector<NamedEdge> named_edges(const Graph& graph, const Object& object) {
    std::vector<NamedEdge> edges;
    for (const Instance& instance : object.instances)
        edges.push_back({graph.objects[instance.master].name, instance});
    for (const PackedEdge& edge : object.packed)
        edges.push_back({name_of(edge.primitive), {0, edge.parent_from_child, {}, edge.material, {}}});
    if (object.terminal) edges.push_back({graph.objects[object.terminal->master].name, *object.terminal});
    return edges;
}

bool equal(const Graph& a, const Object& x, const Graph& b, const Object& y) {
    if (x.primitive != y.primitive || x.combination != y.combination) return false;
    if (x.terminal.has_value() != y.terminal.has_value() || x.terminal_px != y.terminal_px) return false;
    return std::ranges::equal(
        named_edges(a, x), named_edges(b, y), [&](const NamedEdge& p, const NamedEdge& q) {
            return p.master == q.master && equal_attributes(a, p.instance, b, q.instance);
        });
}

bool has_packed(const Graph& graph) {
    return std::ranges::any_of(graph.objects, [](const Object& object) { return bool(object.packed); });
}

std::size_t union_count(const Graph& graph) {
    return static_cast<std::size_t>(
        std::ranges::count_if(graph.objects, [](const Object& object) { return !object.primitive; }));
}

} // namespace

bool same_finish(const Material& a, const Material& b) {
    return std::ranges::all_of(finish_numbers,
                               [&](const FinishNumber& row) { return a.*row.value == b.*row.value; });
}

Interior interior_of(const Material& material) {
    constexpr double least_bending = 1.000001;
    constexpr double least_left = 1e-4; // of a colour's component, which may be 0
    Interior interior{std::max(material.ior, least_bending), Rgb(0.0)};
    if (material.absorption > 0)
        for (int c = 0; c < 3; ++c)
            interior.absorbed[c] =
                -std::log(std::clamp(material.rgb[c], least_left, 1.0)) / material.absorption;
    return interior;
}

bool Material::operator==(const Material& other) const {
    return name == other.name && rgb == other.rgb && same_finish(*this, other) && texture == other.texture &&
           around == other.around && coverage == other.coverage && pattern == other.pattern;
}

ObjectId Graph::add(Object object) {
    objects.push_back(std::move(object));
    return static_cast<ObjectId>(objects.size() - 1);
}

ObjectId Graph::primitive(const Primitive& primitive) {
    for (ObjectId id = 0; id < objects.size(); ++id)
        if (objects[id].primitive == primitive) return id;
    Object object;
    object.name = name_of(primitive);
    object.primitive = primitive;
    return add(std::move(object));
}

std::size_t instance_count(const Graph& graph) {
    std::size_t count = 0;
    for (const Object& object : graph.objects)
        count += object.instances.size();
    return count;
}

ObjectId first_combined(const Graph& graph) {
    return static_cast<ObjectId>(std::ranges::find_if(graph.objects, &Object::is_combined) -
                                 graph.objects.begin());
}

std::size_t edge_count(const Graph& graph) {
    std::size_t count = instance_count(graph);
    for (const Object& object : graph.objects)
        count += object.packed.size();
    return count;
}

bool equal(const Graph& a, const Graph& b) {
    if (union_count(a) != union_count(b) || !(a.settings == b.settings)) return false;
    // Packed edges name kinds of primitives and not objects.
    if (!has_packed(a) && !has_packed(b) && a.objects.size() != b.objects.size()) return false;
    if (a.materials != b.materials || a.objects[a.root].name != b.objects[b.root].name) return false;
    const ObjectsByName others = by_name(b);
    for (const Object& object : a.objects) {
        if (object.primitive) continue;
        const auto other = others.find(object.name);
        if (other == others.end() || !equal(a, object, b, *other->second)) return false;
    }
    return true;
}

} // namespace graftal
