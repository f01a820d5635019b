#include "compiler/graph/text/print.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "compiler/graph/attributes.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

class Printer {
  public:
    explicit Printer(const Graph& graph) : graph_(graph) {}

    std::string scenery() && {
        print_scenery();
        return std::move(out_);
    }

    std::string run() && {
        print_scenery();
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (!graph_.objects[id].primitive) print_object(id);
        return std::move(out_);
    }

  private:
    void print_scenery() {
        for (const Material& material : graph_.materials)
            print_material(material);
        print_settings();
    }

    void print_numbers(std::string_view key, std::initializer_list<double> numbers) {
        out_ += numbers_line(key, std::span(numbers.begin(), numbers.size()));
    }

    void print_vector(std::string_view key, Vec3 v) { print_numbers(key, {v.x, v.y, v.z}); }

    void print_vector(std::string_view key, const std::optional<Vec3>& v) {
        if (v) print_vector(key, *v);
    }

    void print_number(std::string_view key, const std::optional<double>& number) {
        if (number) print_numbers(key, {*number});
    }

    void print_material(const Material& material) {
        out_ += "material " + material.name + " {\n";
        print_vector("  color", material.rgb);
        for (const FinishNumber& row : finish_numbers)
            if (row.always || material.*row.value != Material().*row.value)
                print_numbers("  " + std::string(row.name), {material.*row.value});
        if (!material.texture.empty()) {
            out_ += "  texture: \"" + material.texture + "\"\n";
            print_numbers("  around", {material.around});
        }
        print_pattern(material.pattern);
        out_ += "}\n\n";
    }

    void print_pattern(const SolidPattern& pattern) {
        for (const PatternLayer& layer : pattern.layers) {
            const bool first = &layer == &pattern.layers.front();
            out_ += first ? "  pattern: " : "  plus: ";
            out_ += pattern_words()[static_cast<std::size_t>(layer.kind)];
            out_ += '\n';
            print_numbers("  scale", {layer.scale});
            print_vector("  stretch", layer.stretch);
            print_numbers("  octaves", {static_cast<double>(layer.octaves)});
            print_numbers("  warp", {layer.warp});
            if (layer.of_world) out_ += "  space: world\n";
            if (!first) print_numbers("  share", {layer.share});
        }
        if (!pattern) return;
        print_vector("  low", pattern.low);
        print_vector("  high", pattern.high);
        print_numbers("  bump", {pattern.bump});
    }

    void print_settings() {
        const SceneSettings& settings = graph_.settings;
        const std::size_t before = out_.size();
        if (settings.camera) print_camera(*settings.camera);
        for (const LightSetting& light : settings.lights)
            print_light(light);
        if (settings.background) print_background(*settings.background);
        if (settings.ground) print_ground(*settings.ground);
        if (settings.sky) print_sky(*settings.sky);
        if (settings.film) print_film(*settings.film);
        if (settings.haze) print_haze(*settings.haze);
        if (settings.steps) out_ += "steps: " + std::to_string(*settings.steps) + "\n";
        if (out_.size() > before) out_ += '\n';
    }

    void print_camera(const CameraSetting& camera) {
        out_ += "camera {\n";
        print_vector("  location", camera.location);
        print_vector("  look_at", camera.look_at);
        print_vector("  up", camera.up);
        print_vector("  direction", camera.direction);
        print_number("  angle", camera.angle_deg);
        if (camera.orthographic) out_ += "  orthographic\n";
        print_number("  width", camera.width);
        print_number("  height", camera.height);
        if (camera.aperture) print_numbers("  aperture", {*camera.aperture});
        print_vector("  focus", camera.focus);
        out_ += "}\n";
    }

    void print_light(const LightSetting& light) {
        out_ += "light {\n";
        print_vector(light.sun ? "  sun" : "  location", light.location);
        print_vector("  color", light.rgb);
        if (light.shadowless) out_ += "  shadowless\n";
        if (light.angle_deg > 0) print_numbers("  angle", {light.angle_deg});
        if (light.width > 0) print_numbers("  size", {light.width, light.height});
        if (light.radius > 0) print_numbers("  radius", {light.radius});
        print_vector("  look_at", light.look_at);
        out_ += "}\n";
    }

    void print_background(const BackgroundSetting& background) {
        if (!background.horizon) return print_vector("background", background.rgb);
        out_ += "background {\n";
        print_vector("  zenith", background.rgb);
        print_vector("  horizon", *background.horizon);
        out_ += "}\n";
    }

    void print_ground(const GroundSetting& ground) {
        out_ += "ground {\n";
        print_numbers("  height", {ground.height});
        if (ground.material) out_ += "  material: " + *ground.material + "\n";
        print_vector("  color", ground.rgb);
        if (ground.area) print_area(*ground.area);
        out_ += "}\n";
    }

    void print_sky(const SkySetting& sky) {
        out_ += "sky {\n";
        print_number("  clear", sky.turbidity);
        if (!sky.environment.empty()) {
            out_ += "  environment: \"" + sky.environment + "\"\n";
        } else if (!sky.turbidity) {
            print_vector("  zenith", sky.zenith);
            print_vector("  horizon", sky.horizon);
        }
        if (sky.environment.empty()) print_vector("  below", sky.below);
        print_number("  clouds", sky.clouds);
        if (sky.turn_deg != 0) print_numbers("  turn", {sky.turn_deg});
        print_numbers("  brightness", {sky.brightness});
        if (sky.bounces > 0) out_ += "  bounces: " + std::to_string(sky.bounces) + "\n";
        out_ += "}\n";
    }

    void print_haze(const HazeSetting& haze) {
        out_ += "haze {\n";
        print_numbers("  distance", {haze.distance});
        if (haze.base != 0) print_numbers("  base", {haze.base});
        print_number("  height", haze.height);
        print_vector("  color", haze.rgb);
        if (haze.sun != 0) print_numbers("  sun", {haze.sun});
        out_ += "}\n";
    }

    void print_film(const Film& film) {
        out_ += "film {\n";
        print_numbers("  exposure", {film.exposure});
        print_numbers("  white", {film.white_k});
        out_ += film.soft ? "  soft\n" : "  hard\n";
        out_ += "}\n";
    }

    void print_area(const FlatArea& area) {
        if (area.disc)
            out_ += "  area: disc " + shortest(area.radius) + ", " + shortest(area.centre.x) + ", " +
                    shortest(area.centre.y) + "\n";
        else
            print_numbers("  area", {area.low.x, area.low.y, area.high.x, area.high.y});
    }

    void print_object(ObjectId id) {
        const Object& object = graph_.objects[id];
        out_ += id == graph_.root ? "object " : "canonical object ";
        out_ += object.name + " {\n";
        for (std::size_t i = 0; i < object.instances.size();)
            i = print_group(object, i);
        for (const PackedEdge& edge : object.packed)
            print_packed(edge);
        if (object.terminal) {
            out_ += "  terminal: " + master_name(*object.terminal) + "\n";
            print_attributes(*object.terminal);
            if (object.terminal_px > 0) print_numbers("  below", {object.terminal_px});
        }
        out_ += "}\n\n";
    }

    void print_packed(const PackedEdge& edge) {
        out_ += "  instance: ";
        out_ += name_of(edge.primitive);
        out_ += '\n';
        print_attributes({0, edge.parent_from_child, Tint(), edge.material, Span()});
    }

    /// Writes the instances from `first` on that are placed alike as one statement, as Hart's texts do.
    /// Returns where the next group begins.
    std::size_t print_group(const Object& object, std::size_t first) {
        const std::vector<Instance>& instances = object.instances;
        std::size_t end = first + 1;
        while (end < instances.size() && equal_attributes(graph_, instances[first], graph_, instances[end]))
            ++end;
        if (object.combination == Combination::intersect)
            out_ += "  intersection: ";
        else if (object.combination == Combination::subtract)
            out_ += "  difference: ";
        else
            out_ += end == first + 1 ? "  instance: " : "  union: ";
        for (std::size_t i = first; i < end; ++i) {
            if (i > first) out_ += ", ";
            out_ += master_name(instances[i]);
        }
        out_ += '\n';
        print_attributes(instances[first]);
        return end;
    }

    const std::string& master_name(const Instance& instance) const {
        return graph_.objects[instance.master].name;
    }

    void print_attributes(const Instance& instance) {
        for (const Attribute& attribute : instance_attributes())
            out_ += attribute.text(graph_, instance);
    }

    const Graph& graph_;
    std::string out_;
};

} // namespace

std::string print(const Graph& graph) {
    return Printer(graph).run();
}

std::string print_scenery(const Graph& graph) {
    return Printer(graph).scenery();
}

} // namespace graftal
