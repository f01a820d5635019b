#include "compiler/graph/graph.h"

#include <array>
#include <cmath>
#include <unordered_map>

#include "compiler/support/number.h"

namespace graftal {

namespace {

const std::array<std::string, primitive_kind_count>& primitive_names() {
    static const std::array<std::string, primitive_kind_count> names = [] {
        std::array<std::string, primitive_kind_count> list = {"triangle", "sphere", "cube", "plane",
                                                               "cylinder", "cone",   "torus"};
        for (int i = 1; i < frustum_steps; ++i)
            list[static_cast<std::size_t>(PrimitiveKind::frustum) + static_cast<std::size_t>(i) - 1] =
                "frustum(" + shortest(static_cast<double>(i) / frustum_steps) + ")";
        return list;
    }();
    return names;
}

using ObjectsByName = std::unordered_map<std::string_view, const Object*>;

ObjectsByName by_name(const Graph& graph) {
    ObjectsByName objects;
    for (const Object& object : graph.objects)
        objects.emplace(object.name, &object);
    return objects;
}

bool equal(const Graph& a, const Instance& x, const Graph& b, const Instance& y) {
    if (a.objects[x.master].name != b.objects[y.master].name) return false;
    if (x.material.has_value() != y.material.has_value()) return false;
    if (x.material && !(a.materials[*x.material] == b.materials[*y.material])) return false;
    return x.parent_from_child == y.parent_from_child && x.tint == y.tint;
}

bool equal(const Graph& a, const Object& x, const Graph& b, const Object& y) {
    if (x.primitive != y.primitive || x.instances.size() != y.instances.size()) return false;
    if (x.terminal.has_value() != y.terminal.has_value() || x.terminal_px != y.terminal_px) return false;
    if (x.terminal && !equal(a, *x.terminal, b, *y.terminal)) return false;
    for (std::size_t i = 0; i < x.instances.size(); ++i)
        if (!equal(a, x.instances[i], b, y.instances[i])) return false;
    return true;
}

} // namespace

const char* name_of(PrimitiveKind kind) {
    return primitive_names()[static_cast<std::size_t>(kind)].c_str();
}

std::optional<PrimitiveKind> primitive_named(std::string_view name) {
    static const std::unordered_map<std::string_view, PrimitiveKind> kinds = [] {
        std::unordered_map<std::string_view, PrimitiveKind> map;
        for (std::size_t i = 0; i < primitive_names().size(); ++i)
            map.emplace(primitive_names()[i], static_cast<PrimitiveKind>(i));
        return map;
    }();
    const auto found = kinds.find(name);
    if (found == kinds.end()) return std::nullopt;
    return found->second;
}

PrimitiveKind tapered(double top_radius) {
    const long step = std::lround(top_radius * frustum_steps);
    if (step <= 0) return PrimitiveKind::cone;
    if (step >= frustum_steps) return PrimitiveKind::cylinder;
    return static_cast<PrimitiveKind>(static_cast<long>(PrimitiveKind::frustum) + step - 1);
}

double top_radius(PrimitiveKind kind) {
    if (kind < PrimitiveKind::frustum) return kind == PrimitiveKind::cylinder ? 1 : 0;
    return static_cast<double>(static_cast<int>(kind) - static_cast<int>(PrimitiveKind::frustum) + 1) /
           frustum_steps;
}

bool Material::operator==(const Material& other) const {
    return name == other.name && rgb == other.rgb && ambient == other.ambient && diffuse == other.diffuse &&
           specular == other.specular && roughness == other.roughness && reflection == other.reflection && texture == other.texture &&
           around == other.around && coverage == other.coverage;
}

ObjectId Graph::add(Object object) {
    objects.push_back(std::move(object));
    return static_cast<ObjectId>(objects.size() - 1);
}

ObjectId Graph::primitive(PrimitiveKind kind) {
    for (ObjectId id = 0; id < objects.size(); ++id)
        if (objects[id].primitive == kind) return id;
    Object object;
    object.name = name_of(kind);
    object.primitive = kind;
    return add(std::move(object));
}

std::size_t instance_count(const Graph& graph) {
    std::size_t count = 0;
    for (const Object& object : graph.objects)
        count += object.instances.size();
    return count;
}

bool equal(const Graph& a, const Graph& b) {
    if (a.objects.size() != b.objects.size() || !(a.settings == b.settings)) return false;
    if (a.materials != b.materials || a.objects[a.root].name != b.objects[b.root].name) return false;
    const ObjectsByName others = by_name(b);
    for (const Object& object : a.objects) {
        const auto other = others.find(object.name);
        if (other == others.end() || !equal(a, object, b, *other->second)) return false;
    }
    return true;
}

} // namespace graftal
