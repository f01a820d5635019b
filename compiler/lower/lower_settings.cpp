#include "compiler/lower/lower_settings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/lower/lower_light.h"
#include "compiler/lower/lower_pattern.h"
#include "compiler/lower/named_materials.h"
#include "compiler/lower/scene_fields.h"
#include "compiler/support/number.h"
#include "compiler/syntax/lost_value.h"

namespace graftal {

namespace {

using Kind = SceneStatement::Kind;

constexpr unsigned most_steps = 1'000'000'000;
constexpr unsigned most_around = 1000;
constexpr std::size_t most_candidate_materials = 1000;

bool is_let(const SceneStatement& statement) {
    return statement.kind == Kind::let || statement.kind == Kind::inner;
}

CameraSetting lower_camera(const SceneFields& fields) {
    CameraSetting camera;
    camera.location = fields.place("location");
    camera.look_at = fields.place("look_at");
    camera.up = fields.direction("up");
    camera.direction = fields.direction("direction");
    camera.orthographic = fields.flag("orthographic");
    camera.angle_deg = fields.number(
        "angle", [](double x) { return x >= least_size && x < 180; }, "lie between 0 and 180 degrees");
    camera.width = fields.size("width");
    camera.height = fields.size("height");
    camera.aperture = fields.size("aperture");
    camera.focus = fields.place("focus");
    if (fields.flag("focus") && !fields.flag("aperture"))
        fields.error("focus", "without an 'aperture' everything is in focus");
    if (fields.flag("aperture") && camera.orthographic)
        fields.error("aperture", "an orthographic camera has no lens; leave out 'aperture'");
    if (camera.up == Vec3(0.0)) fields.error("up", "'up' must have a direction");
    if (camera.location && camera.look_at && *camera.location == *camera.look_at)
        fields.error("look_at", "the camera looks at its own location");
    if (camera.width && !camera.orthographic)
        fields.error("width", "'width' belongs to an orthographic camera; give 'angle' instead");
    if (camera.direction == Vec3(0.0)) fields.error("direction", "'direction' must have a direction");
    if (camera.direction && camera.location)
        fields.error("direction", "a camera with a 'location' looks at 'look_at'; leave out 'direction'");
    if (camera.height && !camera.width) fields.error("height", "'height' needs a 'width' beside it");
    if (camera.angle_deg && camera.orthographic)
        fields.error("angle", "an orthographic camera has no 'angle'; give 'width' instead");
    return camera;
}

BackgroundSetting lower_background(const SceneFields& fields) {
    BackgroundSetting background;
    if (!fields.flag("zenith"))
        fields.error_at_statement("this background has no colour", "give it 'zenith: r, g, b'");
    background.rgb = fields.color("zenith").value_or(background.rgb);
    background.horizon = fields.color("horizon");
    return background;
}

GroundSetting lower_ground(const SceneFields& fields) {
    GroundSetting ground;
    ground.height = fields.coordinate("height").value_or(0);
    ground.rgb = fields.color("color");
    if (const SceneField* material = fields.find("material")) ground.material = material->name;
    ground.area = fields.area("area");
    return ground;
}

/// Without a colour of its own the material has the picture's.
void read_texture(const SceneField& field, bool take_colour, Lowering& lowering, Material& material) {
    const std::optional<std::string> path = find_beside(field.name_span, field.name, lowering);
    if (!path) return;
    material.texture = *path;
    if (!lowering.help.look_at_texture) return;
    TextureFacts facts;
    const Status status = lowering.help.look_at_texture(*path, facts);
    if (!status.ok()) lowering.diagnostics.error(field.name_span, status.message());
    material.coverage = facts.coverage;
    if (take_colour) material.rgb = facts.mean;
    if (facts.width < facts.file_width)
        lowering.diagnostics
            .warning(field.name_span,
                     fmt::format("this picture of {} x {} pixels is used at {} x {}", facts.file_width,
                                 facts.file_height, facts.width, facts.height))
            .with_hint("a texture keeps at most 33 million pixels, and all of a model 134 million");
}

/// Reads the texture of a material, and how it lies.
void lower_texture(const SceneFields& fields, Lowering& lowering, Material& material) {
    if (const SceneField* texture = fields.find("texture"))
        read_texture(*texture, !fields.flag("color"), lowering, material);
    else if (fields.flag("around") && material.texture.empty())
        fields.error(
            "around",
            "'around' sets how often a texture repeats around the shape, but the material has no texture");
    if (const auto around = fields.whole("around", 1, most_around)) material.around = *around;
}

void lower_finish(const SceneFields& fields, Material& material) {
    for (const FinishNumber& row : finish_numbers) {
        const auto good = [&](double x) {
            return (row.positive ? x > row.least : x >= row.least) && x <= row.most;
        };
        const std::string range = row.positive
                                      ? fmt::format("be above {} and at most {}", row.least, row.most)
                                      : fmt::format("lie between {} and {}", row.least, row.most);
        double& value = material.*row.value;
        value = fields.number(row.name, good, range).value_or(value);
    }
    // All of Fresnel's, unless it says how much.
    if (fields.flag("ior") && !fields.flag("reflection")) material.reflection = material.has_coat() ? 1 : 0;
    if (!material.is_transparent() && fields.flag("absorption"))
        fields.error("absorption", "'absorption' colours what goes through; give 'transparency' as well");
    if (!material.is_transparent()) material.absorption = 0;
    if (!material.is_transparent() && fields.flag("filter"))
        fields.error("filter", "'filter' colours what goes through; give 'transparency' as well");
    if (!material.is_transparent()) material.filter = 1;
    if (fields.flag("blur") && material.blur > 0 && !material.is_blurred())
        fields.error("blur",
                     "'blur' blurs what a surface mirrors or lets through; give 'reflection', 'ior' or "
                     "'transparency' as well");
    if (!material.is_blurred()) material.blur = 0;
    if (material.metallic > 0 && material.has_coat())
        fields.error(fields.flag("metallic") ? "metallic"
                     : fields.flag("ior")    ? "ior"
                                             : "from",
                     "a metal reflects by its colour, and has no 'ior'; leave out one of the two");
}

/// The material that the field `from` names. `before`: the materials of the statements above.
Material base_of(const SceneFields& fields, std::string_view own_name,
                 const std::vector<SceneStatement>& statements, const std::vector<Material>& before,
                 Diagnostics& diagnostics) {
    const SceneField* const from = fields.find("from");
    if (!from) return {};
    const auto of_name = std::ranges::find_if(statements, [&](const SceneStatement& statement) {
        return statement.kind == Kind::material && statement.name == from->name && from->name != own_name;
    });
    if (of_name != statements.end() &&
        std::ranges::find(before, from->name, &Material::name) == before.end()) {
        diagnostics.error(from->name_span, fmt::format("material '{}' is not known here yet", from->name))
            .with_note(of_name->span, "defined here: move it up");
        return {};
    }
    const Material* const base = find_material(from->name, from->name_span, before, diagnostics);
    return base ? *base : Material();
}

Material lower_material(const SceneFields& fields, const SceneStatement& statement, Material material,
                        Lowering& lowering) {
    material.name = statement.name;
    material.span = statement.span;
    material.rgb = fields.color("color").value_or(material.rgb);
    lower_finish(fields, material);
    lower_texture(fields, lowering, material);
    lower_pattern(fields, lowering.diagnostics, material);
    // POV-Ray would bend and colour light in the holes too.
    if (material.coverage < 1 && (material.has_coat() || material.absorption > 0))
        fields.error_at_statement("the picture of this material has clear parts, so that it is no solid",
                                  "leave out 'ior' and 'absorption'");
    return material;
}

/// Statements that may occur once, and materials once a name.
void check_duplicates(const std::vector<SceneStatement>& statements, Diagnostics& diagnostics) {
    std::map<std::pair<Kind, std::string>, Span> first;
    for (const SceneStatement& statement : statements) {
        if (is_let(statement) || statement.kind == Kind::light) continue;
        const bool named = statement.kind == Kind::material || statement.kind == Kind::preset;
        if (named && statement.name.empty()) continue; // reported already
        const auto [place, fresh] = first.try_emplace({statement.kind, statement.name}, statement.span);
        if (fresh) continue;
        const std::string& keyword = scene_keywords()[static_cast<std::size_t>(statement.kind)];
        diagnostics
            .error(statement.span, named ? fmt::format("duplicate {} '{}'", keyword, statement.name)
                                         : fmt::format("duplicate '{}'", keyword))
            .with_note(place->second, "first defined here");
    }
}

/// A value of an inner parameter; one outside of its range is made 0, so that it is reported once.
void check_inner(std::optional<double>& value, Span span, std::string_view name, Lowering& lowering) {
    if (!value || (*value >= 0 && *value <= 1)) return;
    lowering.diagnostics.error(
        span, fmt::format("{}: an inner parameter lies between 0 and 1, not at {}", name, shortest(*value)));
    value = 0;
}

} // namespace

std::optional<double> set_value(std::string_view setting, const Environment& lets, const Lowering& lowering) {
    const auto set = lowering.options.set.find(setting);
    if (!lowering.at_root_model() || set == lowering.options.set.end() || lets.contains(setting))
        return std::nullopt;
    return set->second;
}

void check_set_names(const Environment& known_lets, const std::vector<std::string>& settings,
                     const std::vector<SceneStatement>& statements, Lowering& lowering) {
    std::vector<std::string> known;
    for (const auto& [name, value] : known_lets)
        known.push_back(name);
    known.insert(known.end(), settings.begin(), settings.end());
    const auto is_known = [&](std::string_view name) {
        return std::find(known.begin(), known.end(), name) != known.end();
    };
    std::set<std::string> reported;
    for (const SceneStatement& statement : statements) {
        if (statement.kind != Kind::preset) continue;
        for (const SceneField& field : statement.fields) {
            const bool taken = lowering.options.preset == statement.name; // then the values are known already
            if (!taken && !field.values.empty()) evaluate(field.values[0], {}, lowering.diagnostics);
            if (is_known(field.keyword)) continue;
            reported.insert(field.keyword);
            lowering.diagnostics
                .error(field.span, fmt::format("preset '{}': the model has no 'let {}' to set",
                                               statement.name, field.keyword))
                .with_hint(choices(field.keyword, known));
        }
    }
    for (const auto& [name, value] : lowering.options.set) {
        if (!is_known(name) && !reported.contains(name))
            lowering.diagnostics.error(Span(), fmt::format("the model has no 'let {}' to set", name))
                .with_hint(choices(name, known));
        if (!std::isfinite(value))
            lowering.diagnostics.error(Span(),
                                       fmt::format("'{}' is set to a value that is not finite", name));
    }
}

void note_parameter(ModelParameter::Kind kind, const std::string& name, const Expression& text, double value,
                    Lowering& lowering) {
    if (!lowering.at_root_model()) return;
    const bool literal =
        text.kind == Expression::Kind::number ||
        (text.kind == Expression::Kind::unary && text.operands.front().kind == Expression::Kind::number);
    // Blocks of an L-system are evaluated for each member of their family.
    if (lowering.noted_places.emplace(text.span.file, text.span.begin).second)
        lowering.notes.parameters.push_back({kind, name, value, text.span, literal});
}

Environment evaluate_lets(const std::vector<SceneStatement>& statements, Environment outer,
                          Lowering& lowering, const Environment& inner) {
    Environment lets = std::move(outer);
    std::map<std::string, Span, std::less<>> first;
    for (const SceneStatement& statement : statements) {
        if (!is_let(statement)) continue;
        const bool is_inner = statement.kind == Kind::inner;
        for (const SceneField& let : statement.fields) {
            if (let.keyword == "pi") {
                lowering.diagnostics.error(let.span, "'pi' is a constant and cannot be set");
                continue;
            }
            const auto [place, fresh] = first.try_emplace(let.keyword, let.span);
            if (!fresh) {
                lowering.diagnostics
                    .error(let.span,
                           fmt::format("duplicate '{} {}'", is_inner ? "inner" : "let", let.keyword))
                    .with_note(place->second, "first defined here");
                continue;
            }
            std::optional<double> value = evaluate(let.values[0], lets, lowering.diagnostics);
            if (is_inner) check_inner(value, let.values[0].span, let.keyword, lowering);
            const auto set = lowering.options.set.find(let.keyword);
            if (set != lowering.options.set.end() && lowering.at_root_model()) {
                value = set->second;
                if (is_inner)
                    check_inner(value, Span(), fmt::format("'{}' as it is set", let.keyword), lowering);
            }
            const auto given = inner.find(let.keyword);
            if (is_inner && given != inner.end()) value = given->second;
            lets[let.keyword] = value.value_or(lost_value);
            note_parameter(is_inner ? ModelParameter::Kind::inner : ModelParameter::Kind::let, let.keyword,
                           let.values[0], lets[let.keyword], lowering);
        }
    }
    return lets;
}

Environment lower_lets(const std::vector<SceneStatement>& statements, Lowering& lowering) {
    Environment lets = evaluate_lets(statements, {}, lowering, lowering.loading.back().inner);
    if (lowering.at_root_model()) check_set_names(lets, {"steps"}, statements, lowering);
    return lets;
}

bool take_preset(const std::vector<SceneStatement>& statements, const std::string& name, FileId file,
                 LowerOptions& options, Diagnostics& diagnostics) {
    const auto is_preset = [](const SceneStatement& statement) { return statement.kind == Kind::preset; };
    const auto found = std::ranges::find_if(statements, [&](const SceneStatement& statement) {
        return is_preset(statement) && statement.name == name;
    });
    if (found == statements.end()) {
        std::vector<std::string> known;
        for (const SceneStatement& statement : statements)
            if (is_preset(statement)) known.push_back(statement.name);
        diagnostics.error(Span{file, 0, 0}, fmt::format("the model has no preset '{}'", name))
            .with_hint(known.empty() ? fmt::format("'preset {} {{ NAME = NUMBER }}' defines one", name)
                                     : choices(name, known));
        return false;
    }
    bool good = true;
    for (const SceneField& field : found->fields) {
        const std::optional<double> value = evaluate(field.values[0], {}, diagnostics);
        if (value)
            options.set.try_emplace(field.keyword, *value);
        else
            good = false;
    }
    return good;
}

void lower_settings(const std::vector<SceneStatement>& statements, const Environment& lets, Graph& graph,
                    Lowering& lowering) {
    check_duplicates(statements, lowering.diagnostics);
    for (const SceneStatement& statement : statements) {
        if (is_let(statement)) continue;
        const SceneFields fields(statement, lets, lowering.diagnostics);
        switch (statement.kind) {
        case Kind::camera:
            graph.settings.camera = lower_camera(fields);
            break;
        case Kind::light:
            graph.settings.lights.push_back(lower_light(fields));
            break;
        case Kind::background:
            graph.settings.background = lower_background(fields);
            break;
        case Kind::ground:
            graph.settings.ground = lower_ground(fields);
            break;
        case Kind::material:
            graph.materials.push_back(lower_material(
                fields, statement,
                base_of(fields, statement.name, statements, graph.materials, lowering.diagnostics),
                lowering));
            break;
        case Kind::steps:
            graph.settings.steps = fields.whole("steps", 0, most_steps);
            break;
        case Kind::sky:
            graph.settings.sky = lower_sky(fields, lowering);
            break;
        case Kind::haze:
            graph.settings.haze = lower_haze(fields);
            break;
        case Kind::film:
            graph.settings.film = lower_film(fields);
            break;
        case Kind::let:
        case Kind::inner:
        case Kind::preset:
            break;
        }
    }
    check_suns(statements, graph.settings, lowering.diagnostics);
    if (const std::optional<double> steps = set_value("steps", lets, lowering)) {
        if (whole_between(0, most_steps)(*steps))
            graph.settings.steps = static_cast<unsigned>(*steps);
        else
            lowering.diagnostics.error(
                Span(), fmt::format("'steps' as it is set must be a whole number between 0 and {}, not {}",
                                    most_steps, shortest(*steps)));
    }
    for (const SceneStatement& statement : statements)
        for (const SceneField& field : statement.fields)
            if (statement.kind == Kind::ground && field.keyword == "material")
                material_named(field.name, field.name_span, graph.materials, lowering.diagnostics);
}

const Material* find_material(std::string_view name, Span span, const std::vector<Material>& materials,
                              Diagnostics& diagnostics) {
    const auto find = [&](const std::vector<Material>& list) -> const Material* {
        const auto found = std::ranges::find(list, name, &Material::name);
        return found == list.end() ? nullptr : &*found;
    };
    if (const Material* own = find(materials)) return own;
    if (const Material* common = find(named_materials())) return common;
    std::vector<std::string> known;
    for (const std::vector<Material>* list : {&materials, &named_materials()})
        for (const Material& material : *list)
            if (known.size() < most_candidate_materials) known.push_back(material.name);
    const std::string hint = choices(name, known);
    diagnostics.error(span, fmt::format("unknown material '{}'", name))
        .with_hint(did_you_mean(name, known).empty()
                       ? fmt::format("material {} {{ color: 0.5, 0.4, 0.1 }} defines it; {}", name, hint)
                       : hint);
    return nullptr;
}

std::optional<MaterialId> material_named(std::string_view name, Span span, std::vector<Material>& materials,
                                         Diagnostics& diagnostics) {
    const Material* const material = find_material(name, span, materials, diagnostics);
    if (!material) return std::nullopt;
    const auto known = std::ranges::find(materials, name, &Material::name) - materials.begin();
    if (static_cast<std::size_t>(known) == materials.size()) materials.push_back(*material);
    return static_cast<MaterialId>(known);
}

} // namespace graftal
