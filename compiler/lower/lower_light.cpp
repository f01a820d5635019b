#include "compiler/lower/lower_light.h"

#include <algorithm>

#include "compiler/light/blackbody.h"
#include "compiler/light/sky_light.h"

namespace graftal {

namespace {

constexpr double most_sun_angle_deg = 90;
constexpr unsigned most_bounces = 16; // a white room keeps 3 % of its light unshown

/// A lamp that is more than a point.
void lower_lamp(const SceneFields& fields, LightSetting& light) {
    const bool rectangle = fields.flag("size"), disc = fields.flag("radius");
    light.look_at = fields.place("look_at");
    if (!rectangle && !disc) {
        if (fields.flag("look_at") && fields.complete())
            fields.error("look_at", "a point of light faces nothing; give it a 'size' or a 'radius'");
        return;
    }
    const char* const shape = rectangle ? "size" : "radius";
    if (rectangle && disc) return fields.error("radius", "a lamp has either a 'size' or a 'radius'");
    if (fields.flag("sun"))
        return fields.error(shape,
                            fmt::format("a sun has no '{}'; its 'angle' is its apparent diameter", shape));
    if (light.shadowless)
        return fields.error(
            shape, fmt::format("a shadowless light has no penumbra; leave out '{}' or 'shadowless'", shape));
    if (!fields.flag("look_at"))
        return fields.error(shape, fmt::format("a lamp with a '{}' needs a 'look_at': what it faces", shape));
    if (light.look_at == light.location) fields.error("look_at", "the lamp looks at its own location");
    if (disc) {
        light.radius = fields.size("radius").value_or(0);
    } else {
        light.width = fields.size("size", 0).value_or(0);
        light.height = fields.size("size", 1).value_or(0);
    }
}

/// Says what of a picture of the sky is not used as it stands.
void report_sky_picture(const LoadedSkyPicture& loaded, Span span, Diagnostics& diagnostics) {
    const SkyPicture& picture = *loaded.picture;
    if (loaded.file_width != 2 * loaded.file_height)
        diagnostics
            .warning(span, fmt::format("this picture of {} x {} pixels is stretched over all directions",
                                       loaded.file_width, loaded.file_height))
            .with_hint("a picture of longitude and latitude is twice as wide as it is high");
    if (picture.width() < loaded.file_width || picture.height() < loaded.file_height)
        diagnostics
            .warning(span, fmt::format("this picture of {} x {} pixels is used at {} x {}", loaded.file_width,
                                       loaded.file_height, picture.width(), picture.height()))
            .with_hint(fmt::format("an environment keeps at most {0} x {0} pixels, and 8 million in all",
                                   most_sky_columns));
    if (loaded.mended > 0)
        diagnostics.warning(
            span, fmt::format("{} of this picture's pixels are no light: negative ones and those that are no "
                              "numbers are taken as 0, and brighter ones than {} as that",
                              loaded.mended, shortest(most_radiance)));
}

void lower_turn(const SceneFields& fields, SkySetting& sky) {
    if (fields.flag("turn") && !fields.flag("environment") && !fields.flag("clouds"))
        return fields.error("turn", "'turn' turns an 'environment' or 'clouds', but this sky has none");
    constexpr double most_turn_deg = 36'000;
    sky.turn_deg = fields
                       .number("turn", between(-most_turn_deg, most_turn_deg),
                               fmt::format("lie within {} degrees", shortest(most_turn_deg)))
                       .value_or(0);
}

void lower_environment(const SceneFields& fields, Lowering& lowering, SkySetting& sky) {
    const SceneField* const field = fields.find("environment");
    if (!field) return;
    for (const char* const other : {"clear", "zenith", "horizon", "below", "clouds"})
        if (fields.flag(other))
            return fields.error(other,
                                fmt::format("an environment has its own light; leave out '{}'", other));
    const std::optional<std::string> path = find_beside(field->name_span, field->name, lowering);
    if (!path) return;
    sky.environment = *path;
    sky.turbidity.reset();
    sky.zenith = sky.horizon = sky.below = Rgb(1.0);
    if (!lowering.help.load_sky_picture || !lowering.at_root_model()) return; // used models bring no light
    LoadedSkyPicture loaded;
    const Status status = lowering.help.load_sky_picture(*path, loaded);
    if (!status.ok()) {
        lowering.diagnostics.error(field->name_span, status.message());
        return;
    }
    report_sky_picture(loaded, field->name_span, lowering.diagnostics);
    sky.picture = loaded.picture;
}

} // namespace

LightSetting lower_light(const SceneFields& fields) {
    LightSetting light;
    light.sun = fields.flag("sun");
    if (light.sun && fields.flag("location"))
        fields.error("location", "a light has either a location or, as a sun, a direction");
    if (!light.sun && !fields.flag("location"))
        fields.error_at_statement("this light has no place", "give it 'location: x, y, z' or 'sun: x, y, z'");
    light.location = (light.sun ? fields.direction("sun") : fields.place("location")).value_or(Vec3(1.0));
    if (light.sun && light.location == Vec3(0.0)) fields.error("sun", "'sun' must have a direction");
    light.rgb = fields.light_color("color").value_or(light.rgb);
    light.shadowless = fields.flag("shadowless");
    if (const std::optional<double> kelvin = fields.temperature("temperature"))
        light.rgb *= blackbody_rgb(*kelvin);
    light.rgb *= fields.brightness("brightness").value_or(1);
    light.angle_deg = fields.within("angle", 0, most_sun_angle_deg, " degrees").value_or(0);
    if (fields.flag("angle") && !light.sun)
        fields.error("angle", "'angle' is the apparent diameter of a sun; this light has a location");
    if (light.angle_deg > 0 && light.shadowless)
        fields.error("angle", "a shadowless light has no penumbra; leave out 'angle' or 'shadowless'");
    lower_lamp(fields, light);
    return light;
}

SkySetting lower_sky(const SceneFields& fields, Lowering& lowering) {
    SkySetting sky;
    const std::optional<Rgb> zenith = fields.light_color("zenith");
    sky.zenith = zenith.value_or(sky.zenith);
    // One colour: the same all over.
    if (zenith && !fields.flag("clear")) sky.horizon = sky.below = *zenith;
    sky.horizon = fields.light_color("horizon").value_or(sky.horizon);
    sky.below = fields.light_color("below").value_or(sky.below);
    sky.turbidity = fields.number("clear", between(ClearSky::least_turbidity, ClearSky::most_turbidity),
                                  fmt::format("lie between {} (pure air) and {} (haze)",
                                              ClearSky::least_turbidity, ClearSky::most_turbidity));
    for (const char* const colour : {"zenith", "horizon"})
        if (fields.flag(colour) && fields.flag("clear"))
            fields.error(colour, fmt::format("a clear sky has its own colours; leave out '{}'", colour));
    sky.brightness = fields.brightness("brightness").value_or(1);
    sky.bounces = fields.whole("bounces", 0, most_bounces).value_or(0);
    sky.clouds = fields.number("clouds", between(0, 1), "lie between 0 (none) and 1 (an overcast sky)");
    lower_turn(fields, sky);
    lower_environment(fields, lowering, sky);
    if (fields.empty())
        fields.error_at_statement("this sky says nothing",
                                  "give it colours, as in 'zenith: 0.3, 0.5, 0.9', 'clear: 3' for a clear "
                                  "sky, or a picture, as in 'environment: \"studio.exr\"'");
    return sky;
}

HazeSetting lower_haze(const SceneFields& fields) {
    HazeSetting haze;
    if (!fields.flag("distance"))
        fields.error_at_statement("this haze has no density",
                                  "give it 'distance: D', at which a third of what lies behind is seen");
    haze.distance = fields.size("distance").value_or(1);
    haze.base = fields.coordinate("base").value_or(0);
    haze.height = fields.size("height");
    haze.rgb = fields.light_color("color");
    haze.sun = fields.within("sun", 0, 1, ", the whole of the haze's light").value_or(0);
    return haze;
}

Film lower_film(const SceneFields& fields) {
    Film film;
    film.soft = !fields.flag("hard");
    film.exposure = fields.brightness("exposure").value_or(1);
    film.white_k = fields.temperature("white").value_or(film.white_k);
    if (fields.flag("hard") && fields.flag("soft")) fields.error("hard", "a film is either hard or soft");
    return film;
}

void check_suns(const std::vector<SceneStatement>& statements, const SceneSettings& settings,
                Diagnostics& diagnostics) {
    using Kind = SceneStatement::Kind;
    const bool of_sky = settings.sky && settings.sky->turbidity,
               of_haze = settings.haze && settings.haze->sun > 0;
    if (std::ranges::any_of(settings.lights, [](const LightSetting& light) { return light.sun; })) return;
    for (const SceneStatement& statement : statements)
        if ((of_sky && statement.kind == Kind::sky) || (of_haze && statement.kind == Kind::haze))
            diagnostics
                .error(statement.span, statement.kind == Kind::sky
                                           ? "a clear sky needs a sun"
                                           : "haze that shows a sun's light needs a sun")
                .with_hint("light { sun: 1, 1, 2  angle: 0.53  temperature: 5500 } is one");
}

} // namespace graftal
