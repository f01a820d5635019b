#include "tests/property/random_graph.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/graph/components.h"
#include "compiler/graph/run.h"
#include "compiler/graph/verify.h"
#include "tests/unit/primitives/all_primitives.h"

namespace graftal::testing {

namespace {

class Generator {
  public:
    Generator(Choices& choices, const RandomGraphOptions& options) : choices_(choices), options_(options) {}

    Graph run() && {
        add_materials();
        const std::uint32_t union_count = 1 + choices_.below(options_.max_objects);
        for (std::uint32_t i = 0; i < union_count; ++i) {
            Object object;
            object.name = union_name(i);
            unions_.push_back(graph_.add(std::move(object)));
        }
        graph_.root = unions_[choices_.below(union_count)];
        for (std::uint32_t i = 0; i < union_count; ++i)
            fill(i);
        add_terminals();
        if (options_.combined) combine();
        if (options_.settings) add_settings();
        if (options_.duplicates && !choices_.one_in(4)) plant_duplicates(graph_, choices_);
        return std::move(graph_);
    }

  private:
    std::string union_name(std::uint32_t i) {
        const std::string number = std::to_string(i);
        switch (choices_.below(4)) {
        case 0:
            return "leaf.o" + number;
        case 1:
            return "tip(" + number + ")";
        case 2:
            return "branch(" + number + ", -0.5)";
        default:
            return "o" + number;
        }
    }

    double number() {
        const std::array<double, 12> numbers = {
            0, -0.0, 1, -1, 0.5, 1.0 / 3, -2, 0.1, 1e-30, options_.huge, 1e-320, -0.7071067811865476};
        const std::uint32_t choice = choices_.below(numbers.size() + 4);
        if (choice < numbers.size()) return numbers[choice];
        return static_cast<double>(choices_.below(1u << 30)) / (1u << 29) - 1;
    }

    double unit() {
        static constexpr std::array<double, 4> numbers = {0, 0.5, 1, 1.0 / 3};
        return numbers[choices_.below(numbers.size())];
    }

    Vec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }

    Rgb colour() {
        const double r = unit(), g = unit();
        return {r, g, unit()};
    }

    void add_materials() {
        const std::uint32_t count = choices_.below(4);
        for (std::uint32_t i = 0; i < count; ++i) {
            Material material;
            material.name = "m" + std::to_string(i);
            material.rgb = colour();
            material.ambient = unit();
            material.roughness = 0.01 + 0.9 * unit();
            if (choices_.one_in(2)) material.reflection = unit();
            // As chance has it of the others, without more of it.
            if (material.ambient < 0.25) material.ior = 1 + material.roughness;
            if (material.ambient > 0.75) material.metallic = material.roughness;
            if (material.rgb.r < 0.25) material.transparency = material.rgb.g;
            if (material.is_transparent() && material.rgb.b < 0.5) material.absorption = 0.1 + material.rgb.b;
            if (material.is_transparent() && material.rgb.b > 0.75) material.filter = 4 - 4 * material.rgb.b;
            if (material.rgb.g > 0.75 && material.reflection > 0) material.blur = material.roughness;
            graph_.materials.push_back(material);
        }
    }

    Affine exact_transform() {
        const std::uint32_t turn = choices_.below(3);
        const double scale = choices_.one_in(2) ? 0.5 : 0.25;
        Affine a{Mat3(0.0), {eighths(), eighths(), eighths()}};
        for (std::uint32_t column = 0; column < 3; ++column)
            a.linear[column][(column + turn) % 3] = choices_.one_in(4) ? -scale : scale;
        return a;
    }

    double eighths() { return choices_.below(17) / 8.0 - 1; }

    Affine transform() {
        if (options_.exact) return exact_transform();
        switch (choices_.below(8)) {
        case 0:
            return {};
        case 1:
            return Affine::translate({1, 0, 0}) * Affine::scale(Vec3(0.5));
        case 2:
            return Affine::scale(Vec3(0.5));
        case 3: // the same except for signs of zeros
            return {Mat3(0.5, -0.0, 0, 0, 0.5, -0.0, -0.0, 0, 0.5), Vec3(-0.0)};
        case 4:
            return Affine::rotate({0, 1, 0}, 30.0 * choices_.below(12)) * Affine::scale({-0.4, 0.6, 0.3});
        case 5: // flat
            return Affine::scale({1, 0, 1});
        case 6:
            return Affine::translate(vector());
        default:
            return any_transform();
        }
    }

    Affine any_transform() {
        Affine a;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                a.linear[column][row] = number();
        a.translation = vector();
        if (largest_entry(a.linear) < 1e-99) a.linear[0][1] = 0.25;
        return a;
    }

    Instance instance_of(ObjectId master) {
        Instance instance;
        instance.master = master;
        instance.parent_from_child = transform();
        if (choices_.one_in(3)) {
            const Rgb rgb = colour();
            instance.tint = {rgb, unit()};
        }
        if (!graph_.materials.empty() && choices_.one_in(4))
            instance.material = choices_.below(static_cast<std::uint32_t>(graph_.materials.size()));
        return instance;
    }

    Primitive primitive() {
        static const std::vector<Primitive> every = test::all_primitives();
        static const std::vector<Primitive> solids = {PrimitiveKind::sphere,   PrimitiveKind::cube,
                                                      PrimitiveKind::cylinder, tapered(0.5),
                                                      PrimitiveKind::torus,    PrimitiveKind::plane};
        const std::vector<Primitive>& all = options_.combined ? solids : every;
        const Primitive& chosen = all[choices_.below(static_cast<std::uint32_t>(all.size()))];
        const bool allowed = !(chosen == PrimitiveKind::plane) || !options_.cycles; // no plane within a cycle
        return allowed ? chosen : PrimitiveKind::sphere;
    }

    /// Without cycles, object i leads to later objects only.
    ObjectId master_for(std::uint32_t i) {
        const auto union_count = static_cast<std::uint32_t>(unions_.size());
        const std::uint32_t first = options_.cycles && choices_.one_in(3) ? 0 : i + 1;
        if (first >= union_count || choices_.one_in(3)) return graph_.primitive(primitive());
        return unions_[first + choices_.below(union_count - first)];
    }

    /// Of a few items, or of so many that they make several ranges.
    void fill_with_run(Object& object) {
        static constexpr std::array<double, 4> tapers = {0, 0.25, 0.5, 1};
        auto run = std::make_shared<Run>();
        object.packed.materials.resize(1 + choices_.below(2));
        for (std::optional<MaterialId>& material : object.packed.materials)
            if (!graph_.materials.empty() && !choices_.one_in(3))
                material = choices_.below(static_cast<std::uint32_t>(graph_.materials.size()));
        for (std::uint32_t left = 1 + choices_.below(choices_.one_in(4) ? 70 : 4); left > 0; --left) {
            RunItem item;
            item.base = {unit(), -1 + 2 * unit(), unit()};
            item.axis = {unit(), unit(), 0.25};
            item.radius = 0.01 + 0.3 * unit();
            item.turn = choices_.below(3) * 0x40000001u;
            item.shape = choices_.one_in(4) ? PrimitiveKind::sphere : tapered(tapers[choices_.below(4)]);
            if (item.shape.is_sphere()) item.axis *= item.radius / glm::length(item.axis);
            item.ball = item.shape == PrimitiveKind::cylinder && choices_.one_in(2);
            item.colour = static_cast<std::uint16_t>(
                choices_.below(static_cast<std::uint32_t>(object.packed.materials.size())));
            run->add(item);
        }
        object.packed.run = std::move(run);
    }

    void fill(std::uint32_t i) {
        if (options_.runs && choices_.one_in(4)) return fill_with_run(graph_.objects[unions_[i]]);
        const std::uint32_t count = 1 + choices_.below(options_.max_instances);
        for (std::uint32_t k = 0; k < count; ++k) {
            const ObjectId master = master_for(i); // may add an object
            Instance instance = instance_of(master);
            std::vector<Instance>& instances = graph_.objects[unions_[i]].instances;
            // Placed like the one before: print groups such instances.
            if (!instances.empty() && choices_.one_in(4)) {
                instance = instances.back();
                instance.master = master;
            }
            instances.push_back(instance);
        }
        if (options_.mirrored && choices_.one_in(2)) add_mirror_images(graph_.objects[unions_[i]].instances);
    }

    void add_mirror_images(std::vector<Instance>& instances) {
        Vec3 mirror(1.0);
        mirror[choices_.below(3)] = -1;
        const std::size_t count = instances.size();
        for (std::size_t i = 0; i < count; ++i) {
            Instance image = instances[i];
            image.parent_from_child = Affine::scale(mirror) * image.parent_from_child;
            instances.push_back(image);
        }
    }

    void add_terminals() {
        const Components components = strong_components(graph_);
        std::vector<ObjectId> ending;
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (!components.unending[id]) ending.push_back(id);
        for (const ObjectId id : unions_) {
            if (graph_.objects[id].packed || ending.empty() || !choices_.one_in(4)) continue;
            const ObjectId master = ending[choices_.below(static_cast<std::uint32_t>(ending.size()))];
            graph_.objects[id].terminal = instance_of(master);
            if (terminals_that_return(graph_, components)[id]) {
                graph_.objects[id].terminal.reset();
                continue;
            }
            if (choices_.one_in(2)) graph_.objects[id].terminal_px = 1 + choices_.below(40);
        }
    }

    /// Combines the instances of some unions, as far as the graph stays one that verify() accepts.
    void combine() {
        for (const ObjectId id : unions_) {
            Object& object = graph_.objects[id];
            if (object.packed || object.instances.size() < 2 || choices_.one_in(3)) continue;
            object.combination = choices_.one_in(2) ? Combination::intersect : Combination::subtract;
            if (!verify(graph_).empty()) object.combination = Combination::unite;
        }
    }

    void add_settings() {
        SceneSettings& settings = graph_.settings;
        if (choices_.one_in(3)) settings.camera = camera();
        for (std::uint32_t i = choices_.below(3); i > 0; --i) {
            const bool sun = choices_.one_in(2);
            const Rgb rgb = colour();
            settings.lights.push_back({Vec3(1, 0.1 * i, -3), sun, rgb, choices_.one_in(2)});
        }
        if (choices_.one_in(3)) {
            settings.background = BackgroundSetting{colour(), {}};
            if (choices_.one_in(2)) settings.background->horizon = colour();
        }
        if (choices_.one_in(3)) {
            GroundSetting ground;
            ground.height = number();
            if (!graph_.materials.empty() && choices_.one_in(2))
                ground.material = graph_.materials.back().name;
            if (choices_.one_in(2)) ground.rgb = colour();
            settings.ground = ground;
        }
        if (choices_.one_in(3)) settings.steps = choices_.below(20);
    }

    CameraSetting camera() {
        CameraSetting camera;
        if (choices_.one_in(2)) camera.location = Vec3(number(), 1, -5);
        if (choices_.one_in(2)) camera.look_at = Vec3(number(), -1, 0);
        if (choices_.one_in(2)) camera.up = Vec3(0, 0, 1);
        camera.orthographic = choices_.one_in(2);
        if (!camera.orthographic && choices_.one_in(2)) camera.angle_deg = 12.5;
        if (camera.orthographic && choices_.one_in(2)) camera.width = 3;
        return camera;
    }

    Choices& choices_;
    const RandomGraphOptions options_;
    Graph graph_;
    std::vector<ObjectId> unions_;
};

} // namespace

std::uint32_t Choices::below(std::uint32_t count) {
    if (!from_bytes_) return static_cast<std::uint32_t>(random_() % count);
    std::uint32_t value = 0;
    for (std::uint64_t reach = 1; reach < count && !bytes_.empty(); reach <<= 8) {
        value = value << 8 | bytes_.front();
        bytes_ = bytes_.subspan(1);
    }
    return value % count;
}

Graph random_graph(Choices& choices, const RandomGraphOptions& options) {
    return Generator(choices, options).run();
}

void plant_duplicates(Graph& graph, Choices& choices) {
    const auto old_count = static_cast<ObjectId>(graph.objects.size());
    std::vector<ObjectId> copy_of(old_count);
    for (ObjectId id = 0; id < old_count; ++id) {
        copy_of[id] = id;
        if (graph.objects[id].primitive) continue;
        Object copy = graph.objects[id];
        copy.name = "copy" + std::to_string(id);
        // The first part of a difference stays the first.
        const auto first = static_cast<std::uint32_t>(copy.combination == Combination::subtract);
        for (auto i = static_cast<std::uint32_t>(copy.instances.size()); i > first + 1; --i)
            std::swap(copy.instances[i - 1], copy.instances[first + choices.below(i - first)]);
        copy_of[id] = graph.add(std::move(copy));
    }
    const auto redirect = [&](Instance& instance) {
        if (choices.one_in(2)) instance.master = copy_of[instance.master];
    };
    for (Object& object : graph.objects) {
        std::for_each(object.instances.begin(), object.instances.end(), redirect);
        if (object.terminal) redirect(*object.terminal);
    }
}

Graph permuted(const Graph& graph, Choices& choices) {
    std::vector<ObjectId> new_id(graph.objects.size());
    std::iota(new_id.begin(), new_id.end(), 0u);
    for (std::size_t i = new_id.size(); i > 1; --i)
        std::swap(new_id[i - 1], new_id[choices.below(static_cast<std::uint32_t>(i))]);
    Graph result = graph;
    result.root = new_id[graph.root];
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        Object& object = result.objects[new_id[id]] = graph.objects[id];
        for (Instance& instance : object.instances)
            instance.master = new_id[instance.master];
        if (object.terminal) object.terminal->master = new_id[object.terminal->master];
    }
    return result;
}

} // namespace graftal::testing
