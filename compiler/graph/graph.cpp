#include "compiler/graph/graph.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "compiler/graph/attributes.h"
#include "compiler/graph/run.h"

namespace graftal {

namespace {

using ObjectsByName = std::unordered_map<std::string_view, const Object*>;

ObjectsByName by_name(const Graph& graph) {
    ObjectsByName objects;
    for (const Object& object : graph.objects)
        objects.emplace(object.name, &object);
    return objects;
}

/// The instances of an object one by one, those that a run means too.
class Parts {
  public:
    Parts(const Graph& graph, const Object& object) : graph_(graph), object_(object) {}

    struct Part {
        std::string_view master;
        Instance instance; ///< apart from its master
    };

    std::size_t count() const { return object_.run ? object_.run->part_count() : object_.instances.size(); }

    Part of(const Instance& instance) const { return {graph_.objects[instance.master].name, instance}; }

    /// Requires that one is left.
    Part next() {
        if (!object_.run) return of(object_.instances[next_++]);
        const RunItem& item = (*object_.run)[next_];
        const bool ball = at_ball_;
        at_ball_ = item.ball && !ball;
        if (!at_ball_) ++next_;
        Part part{name_of(ball ? Primitive(PrimitiveKind::sphere) : item.shape.primitive()), {}};
        part.instance.parent_from_child = ball ? run_from_ball(item) : run_from_body(item);
        part.instance.material = object_.run_materials[item.colour];
        return part;
    }

  private:
    const Graph& graph_;
    const Object& object_;
    std::size_t next_ = 0;
    bool at_ball_ = false;
};

bool equal(const Graph& a, const Object& x, const Graph& b, const Object& y) {
    Parts parts_of_x(a, x), parts_of_y(b, y);
    const auto alike = [&](const Parts::Part& p, const Parts::Part& q) {
        return p.master == q.master && equal_attributes(a, p.instance, b, q.instance);
    };
    if (x.primitive != y.primitive || parts_of_x.count() != parts_of_y.count()) return false;
    if (x.terminal.has_value() != y.terminal.has_value() || x.terminal_px != y.terminal_px) return false;
    if (x.terminal && !alike(parts_of_x.of(*x.terminal), parts_of_y.of(*y.terminal))) return false;
    for (std::size_t left = parts_of_x.count(); left > 0; --left)
        if (!alike(parts_of_x.next(), parts_of_y.next())) return false;
    return true;
}

bool has_run(const Graph& graph) {
    return std::ranges::any_of(graph.objects, [](const Object& object) { return object.run != nullptr; });
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
           around == other.around && coverage == other.coverage;
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

std::size_t run_part_count(const Graph& graph) {
    std::size_t count = 0;
    for (const Object& object : graph.objects)
        if (object.run) count += object.run->part_count();
    return count;
}

bool equal(const Graph& a, const Graph& b) {
    if (union_count(a) != union_count(b) || !(a.settings == b.settings)) return false;
    // Runs name kinds of primitives and not objects.
    if (!has_run(a) && !has_run(b) && a.objects.size() != b.objects.size()) return false;
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
