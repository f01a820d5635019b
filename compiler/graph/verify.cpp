#include "compiler/graph/verify.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "compiler/graph/attributes.h"
#include "compiler/graph/components.h"
#include "compiler/graph/path.h"
#include "compiler/graph/planes.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Whether lexers take it for a name: a letter or '_', then letters, digits, '_', and dots before letters.
bool is_plain_name(std::string_view name) {
    if (name.empty() || !is_letter(name.front()) || name.back() == '.') return false;
    for (std::size_t i = 1; i < name.size(); ++i) {
        const bool dot_before_letter = name[i] == '.' && is_letter(name[i + 1]);
        if (!is_letter(name[i]) && !is_digit(name[i]) && !dot_before_letter) return false;
    }
    return true;
}

/// A plain name, or one with the numbers of a parametric object: `tip(3)`, `branch(2, 0.5)`; or a mesh with
/// its file.
bool is_object_name(std::string_view name) {
    constexpr std::string_view mesh_begins = "mesh(\"", mesh_ends = "\")";
    if (name.starts_with(mesh_begins) && name.ends_with(mesh_ends))
        return name.find('"', mesh_begins.size()) == name.size() - mesh_ends.size();
    const std::size_t parenthesis = name.find('(');
    if (parenthesis == std::string_view::npos) return is_plain_name(name);
    if (!is_plain_name(name.substr(0, parenthesis)) || name.back() != ')') return false;
    std::string_view arguments = name.substr(parenthesis + 1, name.size() - parenthesis - 2);
    while (true) {
        const std::size_t comma = arguments.find(',');
        const std::string_view argument = arguments.substr(0, comma);
        const std::optional<double> value = parse_number(argument);
        if (!value || shortest(*value) != argument) return false;
        if (comma == std::string_view::npos) return true;
        if (!arguments.substr(comma).starts_with(", ")) return false;
        arguments.remove_prefix(comma + 2);
    }
}

// Whether all numbers of a value are finite. Each setting is taken apart, so that one with a new field does
// not compile until somebody decides on that field here.

bool finite(double value) {
    return std::isfinite(value);
}

bool finite(Vec2 v) {
    return finite(v.x) && finite(v.y);
}

bool finite(Vec3 v) {
    return finite(v.x) && finite(v.y) && finite(v.z);
}

template<typename T> bool finite(const std::optional<T>& value);

template<typename... T> bool all_finite(const T&... values) {
    return (finite(values) && ...);
}

bool finite(const FlatArea& area) {
    const auto& [disc, low, high, centre, radius] = area;
    return all_finite(low, high, centre, radius);
}

bool finite(const CameraSetting& setting) {
    const auto& [location, look_at, up, direction, angle_deg, orthographic, width, height, aperture, focus] =
        setting;
    return all_finite(location, look_at, up, direction, angle_deg, width, height, aperture, focus);
}

bool finite(const LightSetting& setting) {
    const auto& [location, sun, rgb, shadowless, angle_deg, width, height, radius, look_at] = setting;
    return all_finite(location, rgb, angle_deg, width, height, radius, look_at);
}

bool finite(const BackgroundSetting& setting) {
    const auto& [rgb, horizon] = setting;
    return all_finite(rgb, horizon);
}

bool finite(const GroundSetting& setting) {
    const auto& [height, material, rgb, area] = setting;
    return all_finite(height, rgb, area);
}

bool finite(const SkySetting& setting) {
    const auto& [zenith, horizon, below, turbidity, environment, picture, clouds, turn_deg, brightness,
                 bounces] = setting;
    return all_finite(zenith, horizon, below, turbidity, clouds, turn_deg, brightness);
}

bool finite(const Film& film) {
    const auto& [exposure, white_k, soft] = film;
    return all_finite(exposure, white_k);
}

bool finite(const HazeSetting& setting) {
    const auto& [distance, base, height, rgb, sun] = setting;
    return all_finite(distance, base, height, rgb, sun);
}

template<typename T> bool finite(const std::optional<T>& value) {
    return !value || finite(*value);
}

class Verifier {
  public:
    explicit Verifier(const Graph& graph) : graph_(graph) {}

    std::vector<Flaw> run() && {
        check_root();
        check_names();
        check_materials();
        check_settings();
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            check_object(id);
        if (flaws_.empty()) check_cycles(); // needs masters that exist
        return std::move(flaws_);
    }

  private:
    template<typename... Args> void flaw(ObjectId object, fmt::format_string<Args...> text, Args&&... args) {
        flaws_.push_back({object, fmt::format(text, std::forward<Args>(args)...)});
    }

    void check_root() {
        if (graph_.root >= graph_.objects.size())
            flaw(graph_.root, "the root is object {} of {}", graph_.root, graph_.objects.size());
        else if (graph_.objects[graph_.root].primitive)
            flaw(graph_.root, "the root is a primitive, not a union");
    }

    void check_names() {
        std::unordered_map<std::string_view, ObjectId> first;
        for (ObjectId id = 0; id < graph_.objects.size(); ++id) {
            const Object& object = graph_.objects[id];
            const auto [other, is_new] = first.emplace(object.name, id);
            if (!is_new) flaw(id, "the name is that of object {} too", other->second);
            if (object.primitive && object.name != name_of(*object.primitive))
                flaw(id, "a primitive '{}' under another name", name_of(*object.primitive));
            // Objects may have the names of kinds with shapes; no two objects have the same name in any case.
            const auto kind = primitive_kind_named(object.name.substr(0, object.name.find('(')));
            if (!object.primitive && kind && form_of(*kind) != PrimitiveForm::shaped)
                flaw(id, "a union with a primitive's name");
            if (!is_object_name(object.name)) flaw(id, "the name cannot be written in .inst");
        }
    }

    void check_materials() {
        std::unordered_map<std::string_view, MaterialId> first;
        for (MaterialId id = 0; id < graph_.materials.size(); ++id) {
            const Material& material = graph_.materials[id];
            if (!first.emplace(material.name, id).second)
                flaw(graph_.root, "two materials are named '{}'", material.name);
            if (!is_plain_name(material.name))
                flaw(graph_.root, "the name of material '{}' cannot be written in .inst", material.name);
            const bool numbers = all_finite(material.rgb, material.around, material.coverage) &&
                                 std::ranges::all_of(finish_numbers, [&](const FinishNumber& row) {
                                     return std::isfinite(material.*row.value);
                                 });
            if (!numbers) flaw(graph_.root, "material '{}' has a number that is not finite", material.name);
            check_pattern(material);
            if (material.metallic > 0 && material.has_coat())
                flaw(graph_.root, "material '{}' is a metal with an index of refraction", material.name);
            if (material.absorption > 0 && !material.is_transparent())
                flaw(graph_.root, "material '{}' is opaque and absorbs", material.name);
            if (material.filter != 1 && !material.is_transparent())
                flaw(graph_.root, "material '{}' is opaque and has a filter", material.name);
            if (material.blur > 0 && !material.is_blurred())
                flaw(graph_.root, "material '{}' has nothing to blur", material.name);
        }
    }

    void check_pattern(const Material& material) {
        const SolidPattern& pattern = material.pattern;
        if (!pattern) return;
        if (!material.texture.empty())
            flaw(graph_.root, "material '{}' has a pattern and a picture", material.name);
        bool sound = pattern.layers.size() <= SolidPattern::most_layers &&
                     all_finite(pattern.low, pattern.high, pattern.bump);
        for (const PatternLayer& layer : pattern.layers) {
            const bool first = &layer == &pattern.layers.front();
            sound = sound && all_finite(layer.stretch, layer.warp, layer.scale) && layer.scale > 0 &&
                    layer.share > 0 && (first ? layer.share == 1 : layer.share < 1) && layer.octaves >= 1 &&
                    layer.octaves <= SolidPattern::most_octaves &&
                    std::min({layer.stretch.x, layer.stretch.y, layer.stretch.z}) > 0;
        }
        if (!sound) flaw(graph_.root, "material '{}' has a pattern that is none", material.name);
    }

    void check_settings() {
        const auto& [camera, lights, background, ground, sky, film, haze, steps] = graph_.settings;
        const auto check = [&](std::string_view name, const auto& setting) {
            if (!finite(setting)) flaw(graph_.root, "the {} has a number that is not finite", name);
        };
        check("camera", camera);
        for (const LightSetting& light : lights)
            check("light", light);
        check("background", background);
        check("ground", ground);
        check("sky", sky);
        check("film", film);
        check("haze", haze);
        if (ground && ground->material &&
            std::ranges::find(graph_.materials, *ground->material, &Material::name) == graph_.materials.end())
            flaw(graph_.root, "the ground's material '{}' does not exist", *ground->material);
    }

    void check_object(ObjectId id) {
        const Object& object = graph_.objects[id];
        if (object.primitive) {
            if (!object.instances.empty()) flaw(id, "a primitive with instances");
            if (object.terminal) flaw(id, "a primitive with a terminal");
            if (object.is_combined()) flaw(id, "a primitive that combines");
        } else if (object.instances.empty() && !object.packed) {
            flaw(id, "an empty union");
        }
        if (object.packed) check_packed(id, object);
        for (std::size_t i = 0; i < object.instances.size(); ++i)
            check_instance(id, i, object.instances[i]);
        if (object.terminal) check_instance(id, std::nullopt, *object.terminal);
        const bool sized = std::isfinite(object.terminal_px) && object.terminal_px >= 0;
        if (!sized || (object.terminal_px > 0 && !object.terminal))
            flaw(id, "a terminal drawn below {} px", object.terminal_px);
    }

    void check_packed(ObjectId id, const Object& object) {
        if (object.primitive || !object.instances.empty() || object.terminal || object.is_combined())
            flaw(id, "a run beside other parts");
        if (object.packed.size() == 0) flaw(id, "an empty run");
        for (const std::optional<MaterialId>& material : object.packed.materials)
            if (material && *material >= graph_.materials.size())
                flaw(id, "a run has material {} of {}", *material, graph_.materials.size());
        if (const std::optional<std::size_t> item = object.packed.unsound_item())
            flaw(id, "item {} of a run is not sound", *item);
    }

    /// `index`: of the instance; nothing for a terminal.
    void check_instance(ObjectId id, std::optional<std::size_t> index, const Instance& instance) {
        const auto fault = [&](const std::string& what) {
            flaw(id, "{} {}", index ? fmt::format("instance {}", *index) : "the terminal", what);
        };
        if (instance.master >= graph_.objects.size())
            fault(fmt::format("has master {} of {} objects", instance.master, graph_.objects.size()));
        for (const Attribute& attribute : instance_attributes())
            if (const std::string what = attribute.fault(graph_, instance); !what.empty()) fault(what);
    }

    void check_cycles() {
        const Components components = strong_components(graph_);
        const std::vector<bool> holds_plane = plane_holders(graph_, components);
        const std::vector<bool> returns = terminals_that_return(graph_, components);
        for (ObjectId id = 0; id < graph_.objects.size(); ++id) {
            check_parts(id, components);
            check_combined(id, components, holds_plane);
            const std::optional<Instance>& terminal = graph_.objects[id].terminal;
            if (terminal && components.unending[terminal->master])
                flaw(id, "the terminal '{}' is unending", graph_.objects[terminal->master].name);
            if (returns[id])
                flaw(id, "the terminal '{}' leads back to it", graph_.objects[terminal->master].name);
            const bool plane = holds_plane[id] || (terminal && holds_plane[terminal->master]);
            if (plane && components.cyclic[components.component_of[id]])
                flaw(id, "a plane is reached through a cycle");
        }
    }

    void check_combined(ObjectId id, const Components& components, const std::vector<bool>& holds_plane) {
        const Object& object = graph_.objects[id];
        if (!object.is_combined() || object.instances.empty()) return;
        if (components.cyclic[components.component_of[id]]) flaw(id, "an operand leads back to it");
        if (holds_plane[id]) flaw(id, "its operands leave it without bounds");
    }

    /// Every way round a cycle takes a level.
    void check_parts(ObjectId id, const Components& components) {
        for (const Instance& instance : graph_.objects[id].instances) {
            if (!is_part(instance, components)) continue;
            const Object& part = graph_.objects[instance.master];
            const bool has_parts =
                std::any_of(part.instances.begin(), part.instances.end(),
                            [&](const Instance& other) { return is_part(other, components); });
            if (part.terminal || has_parts) flaw(id, "the part '{}' has a terminal or parts", part.name);
        }
    }

    const Graph& graph_;
    std::vector<Flaw> flaws_;
};

} // namespace

std::vector<Flaw> verify(const Graph& graph) {
    return Verifier(graph).run();
}

void check_verified(const Graph& graph, std::string_view stage) {
    const std::vector<Flaw> flaws = verify(graph);
    if (flaws.empty()) return;
    const Flaw& flaw = flaws.front();
    const std::string_view name =
        flaw.object < graph.objects.size() ? std::string_view(graph.objects[flaw.object].name) : "(none)";
    GRAFTAL_CHECK(flaws.empty(), fmt::format("{}: object {}: {}", stage, name, flaw.message));
}

} // namespace graftal
