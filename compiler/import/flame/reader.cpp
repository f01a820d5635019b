#include "compiler/import/flame/reader.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "compiler/import/flame/variations.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"

namespace graftal::flame {

namespace {

/// The number that a text is; nothing where it is none, or too large for any use.
std::optional<double> number_in(std::string_view text) {
    const std::optional<double> value = parse_number(text);
    return value && std::abs(*value) <= 1e50 ? value : std::nullopt;
}

/// `all`: becomes false where a word is no number.
std::vector<double> numbers_in(std::string_view text, bool* all = nullptr) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (true) {
        at = text.find_first_not_of(" \t\r\n,", at);
        if (at == std::string_view::npos) return numbers;
        const std::size_t end = std::min(text.find_first_of(" \t\r\n,", at), text.size());
        const std::optional<double> value = number_in(text.substr(at, end - at));
        if (all && !value) *all = false;
        numbers.push_back(value.value_or(0));
        at = end;
    }
}

/// The number of an attribute; `fallback` where it is missing or none.
double number_of(const pugi::xml_attribute& attribute, double fallback) {
    return number_in(trimmed(attribute.value())).value_or(fallback);
}

/// Fractorium and the plugins of Apophysis have some variations and numbers by other names.
std::string name_in_flam3(std::string name) {
    if (name.starts_with("Mobius")) return in_small_letters(name);
    if (name.starts_with("oscope_")) return name.replace(0, 6, "oscilloscope");
    if (name.size() == 4 && (name.starts_with("Re_") || name.starts_with("Im_")))
        return "mobius_" + in_small_letters(name);
    return name;
}

/// The attributes that a map has, and its curves over time as JWildfire writes them: `weightCurve` of
/// `weightCurve_enabled`.
struct Attributes {
    explicit Attributes(const pugi::xml_node& node) {
        constexpr std::string_view enabled = "_enabled";
        for (const pugi::xml_attribute& attribute : node.attributes()) {
            const std::string_view name = attribute.name();
            names.insert(name);
            if (name.ends_with(enabled)) curves.insert(name.substr(0, name.size() - enabled.size()));
        }
    }

    /// The variation that an attribute is a number of: one that the map has, or one that it could have.
    /// Whatever its value, the attribute means nothing without the variation. "" for none.
    std::string_view variation_of(std::string_view name) const {
        return owner_of(name, [&](auto owner) { return is_variation(owner) || names.contains(owner); });
    }
    std::string_view curve_of(std::string_view name) const {
        return owner_of(name, [&](auto owner) { return curves.contains(owner); });
    }

    std::set<std::string_view> names, curves;

  private:
    /// The shortest part of a name before a '_' for which the test holds.
    template<typename Test> static std::string_view owner_of(std::string_view name, const Test& is_owner) {
        constexpr std::size_t longest = 200; // no name of a program is longer
        name = name.substr(0, longest);
        for (std::size_t end = name.find('_'); end != std::string_view::npos; end = name.find('_', end + 1))
            if (is_owner(name.substr(0, end))) return name.substr(0, end);
        return {};
    }
};

/// Attributes that are no variation, whatever their value.
bool is_attribute(std::string_view name) {
    static const std::set<std::string_view> read = {"weight", "color", "symmetry", "color_speed", "coefs",
                                                    "post",   "chaos", "opacity",  "name",        "plotmode",
                                                    "var",    "var1",  "density"};
    static const std::set<std::string_view> idle = {// they change no single picture
                                                    "animate",      "var_color",        "pulsation",
                                                    "slider",       "motion_frequency", "motion_function",
                                                    "motion_offset"};
    return read.contains(name) || idle.contains(name);
}

/// Attributes of JWildfire that change a picture in a way that graftal does not know.
bool is_left_out(std::string_view name) {
    static constexpr std::string_view prefixes[] = {"mod_", "wfield_", "material"};
    static const std::set<std::string_view> names = {"color_type", "targetcolor", "yzCoefs",
                                                     "yzPost",     "zxCoefs",     "zxPost"};
    return names.contains(name) ||
           std::ranges::any_of(prefixes, [&](std::string_view prefix) { return name.starts_with(prefix); });
}

} // namespace

const pugi::xml_document* Reader::document() {
    const std::string_view text = file_.text();
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (result) return &document_;
    const auto at = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(result.offset, 0, static_cast<std::ptrdiff_t>(text.size())));
    file_.diagnostics.error(file_.span(at, at), fmt::format("this is no XML: {}", result.description()));
    return nullptr;
}

Span Reader::span(const pugi::xml_node& node) const {
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    return file_.span(at, std::min(at + std::string_view(node.name()).size(), file_.text().size()));
}

std::optional<Flame> Reader::read(const pugi::xml_node& node) {
    Flame flame;
    const std::size_t errors = file_.diagnostics.error_count();
    const std::vector<double> centre = numbers_in(node.attribute("center").value());
    if (centre.size() == 2) flame.centre = {centre[0], centre[1]};
    const std::vector<double> size = numbers_in(node.attribute("size").value());
    if (size.size() == 2) flame.width = size[0];
    // JWildfire enlarges by a factor, flam3 by a power of two.
    const double factor = number_of(node.attribute("cam_zoom"), 1);
    flame.scale = number_of(node.attribute("scale"), 0) * (factor > 0 ? factor : 1) *
                  std::exp2(std::clamp(number_of(node.attribute("zoom"), 0), -100.0, 100.0));
    flame.rotate = number_of(node.attribute("rotate"), 0);
    const std::vector<double> background = numbers_in(node.attribute("background").value());
    if (background.size() == 3)
        for (std::size_t i = 0; i < 3; ++i)
            flame.background[i] = std::clamp(background[i], 0.0, 1.0);
    // The camera in space, of flames that leave the plane.
    for (const char* const name :
         {"cam_pitch", "cam_yaw", "cam_perspective", "cam_persp", "cam_zpos", "cam_zdimish", "cam_dof"})
        if (node.attribute(name).as_double() != 0) leave_out(span(node), name);
    for (const pugi::xml_node& child : node.children()) {
        const std::string_view name = child.name();
        if (name == "xform" || name == "finalxform") {
            Map map = read_map(child);
            if (name == "finalxform")
                flame.last = std::move(map);
            else
                flame.maps.push_back(std::move(map));
            if (flame.maps.size() > most_maps) {
                file_.diagnostics.error(span(child), fmt::format("a flame has at most {} maps", most_maps));
                return std::nullopt;
            }
        } else if (name == "color" || name == "colour") {
            const std::vector<double> rgb = numbers_in(child.attribute("rgb").value());
            const int index = child.attribute("index").as_int(-1);
            if (index >= 0 && index < 256 && rgb.size() == 3)
                set_colour(flame, index, Rgb(rgb[0], rgb[1], rgb[2]) / 255.0);
        } else if (name == "palette" || name == "colors") {
            read_palette(child, flame);
        } else if (name == "symmetry") {
            flame.symmetry = child.attribute("kind").as_int(1);
            flame.symmetry_span = span(child);
        } else if (child.type() == pugi::node_element && name != "edit") {
            file_.diagnostics.warning(span(child), fmt::format("'{}' is left out", name));
        }
    }
    drop_idle_maps(flame);
    report_left_out();
    if (flame.maps.empty())
        file_.diagnostics.error(span(node), "this flame has no maps ('xform') with a weight");
    if (file_.diagnostics.error_count() > errors) return std::nullopt;
    return flame;
}

/// Maps without a weight, and the factors of `chaos` that stand for them.
void Reader::drop_idle_maps(Flame& flame) {
    std::vector<bool> idle;
    for (const Map& map : flame.maps)
        idle.push_back(map.weight == 0);
    std::erase_if(flame.maps, [](const Map& map) { return map.weight == 0; });
    for (Map& map : flame.maps) {
        std::vector<double> kept;
        for (std::size_t i = 0; i < map.chaos.size() && i < idle.size(); ++i)
            if (!idle[i]) kept.push_back(map.chaos[i]);
        map.chaos = std::move(kept);
    }
}

void Reader::set_colour(Flame& flame, int index, Rgb encoded) {
    const auto part = [](double v) { return std::clamp(v, 0.0, 1.0); };
    flame.palette[static_cast<std::size_t>(index)] = {part(encoded.r), part(encoded.g), part(encoded.b)};
    flame.has_colour[static_cast<std::size_t>(index)] = true;
}

/// Six hexadecimal digits a colour, or eight with two in front.
void Reader::read_palette(const pugi::xml_node& node, Flame& flame) {
    std::string digits;
    std::string_view text = node.child_value();
    if (text.empty()) text = node.attribute("data").value();
    for (const char c : text)
        if (std::isxdigit(static_cast<unsigned char>(c))) digits += c;
    const auto count = static_cast<std::size_t>(std::max(1, node.attribute("count").as_int(256)));
    const std::size_t each = digits.size() >= 8 * count ? 8 : 6;
    for (std::size_t i = 0; i < 256 && each * (i + 1) <= digits.size(); ++i) {
        const std::string_view colour = std::string_view(digits).substr(each * i + each - 6, 6);
        set_colour(flame, static_cast<int>(i), srgb_from_hex(colour).value_or(Rgb(0.0)));
    }
}

Affine Reader::coefficients(const pugi::xml_attribute& attribute, Span place) {
    Affine map;
    if (!attribute) return map;
    bool all = true;
    const std::vector<double> n = numbers_in(attribute.value(), &all);
    if (n.size() != 6 || !all) {
        file_.diagnostics.error(place, fmt::format("'{}' takes six numbers", attribute.name()));
        return map;
    }
    map.linear[0] = {n[0], n[1], 0};
    map.linear[1] = {n[2], n[3], 0};
    map.translation = {n[4], n[5], 0};
    return map;
}

Map Reader::read_map(const pugi::xml_node& node) {
    Map map;
    map.span = span(node);
    map.pre = coefficients(node.attribute("coefs"), map.span);
    map.post = coefficients(node.attribute("post"), map.span);
    map.weight = number_of(node.attribute("weight"), number_of(node.attribute("density"), 0));
    map.weight = std::clamp(map.weight, 0.0, 1e6);
    const std::vector<double> colour = numbers_in(node.attribute("color").value()); // flam3 had two once
    map.colour = std::clamp(colour.empty() ? 0.0 : colour[0], 0.0, 1.0);
    if (node.attribute("symmetry")) map.speed = (1 - number_of(node.attribute("symmetry"), 0)) / 2;
    if (node.attribute("color_speed")) map.speed = number_of(node.attribute("color_speed"), 0.5);
    map.speed = std::clamp(map.speed, 0.0, 1.0);
    map.opacity = number_of(node.attribute("opacity"), 1);
    bool all = true;
    map.chaos = numbers_in(node.attribute("chaos").value(), &all);
    if (!all) file_.diagnostics.error(map.span, "'chaos' takes numbers, one for each map");
    map.name = node.attribute("name").value();
    if (std::string_view(node.attribute("plotmode").value()) == "off") map.opacity = 0;
    read_variations(node, map);
    return map;
}

void Reader::read_variations(const pugi::xml_node& node, Map& map) {
    bool flat = false;
    std::vector<std::string> unknown;
    const Attributes attributes(node);
    const auto fail = [&](std::string message) { file_.diagnostics.error(map.span, std::move(message)); };
    for (const pugi::xml_attribute& attribute : node.attributes()) {
        const std::string name = name_in_flam3(attribute.name());
        if (is_attribute(name)) continue;
        const std::optional<double> number = parse_number(trimmed(attribute.value()));
        const double value = std::clamp(number.value_or(0), -1e6, 1e6);
        const std::string_view owner = attributes.variation_of(name);
        if (leaves_the_plane(name)) {
            flat = true;
            if (value != 0 && name.find("flatten") == std::string::npos) leave_out(map.span, name);
        } else if (is_variation(name)) {
            if (!number)
                fail(fmt::format("'{}' takes a number, not '{}'", name, comment_text(attribute.value())));
            else if (value != 0)
                map.variations.emplace_back(name, value);
        } else if (const std::string_view curve = attributes.curve_of(name); !curve.empty()) {
            leave_out(map.span, fmt::format("{}_*", curve));
        } else if (!number || is_left_out(name)) {
            leave_out(map.span, name);
        } else if (name.ends_with("_fx_priority") && is_variation(owner) && value != 0) {
            fail(fmt::format("'{}' is not translated: the variation is no summand of its map", name));
        } else if (!owner.empty()) {
            map.numbers.emplace(name, value);
        } else if (value != 0) {
            unknown.push_back(name);
        } else {
            leave_out(map.span, name);
        }
    }
    // An unknown name with a '_' may be a number of an unknown variation: it is reported only where there is
    // no other.
    const auto is_whole = [](std::string_view name) { return name.find('_') == std::string_view::npos; };
    const bool some_whole = std::ranges::any_of(unknown, is_whole);
    for (const std::string& name : unknown)
        if (!some_whole || is_whole(name)) fail(fmt::format("the variation '{}' is not translated", name));
    read_old_variations(node, map);
    // A map that only flattens makes the one point; one with coefficients and no variation is linear.
    if (map.variations.empty() && !node.attribute("coefs").empty())
        map.variations.emplace_back("linear", flat ? 0 : 1);
}

void Reader::leave_out(const Span& at, const std::string& attribute) {
    left_out_.insert(comment_text(attribute));
    if (!left_out_span_.known()) left_out_span_ = at;
}

void Reader::report_left_out() {
    constexpr std::size_t most_named = 30;
    if (left_out_.empty()) return;
    std::string names;
    std::size_t count = 0;
    for (const std::string& name : left_out_)
        if (++count <= most_named) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name);
    if (count > most_named) names += fmt::format(" and {} more", count - most_named);
    file_.diagnostics.warning(left_out_span_,
                              fmt::format("the flame is drawn without the attributes {}", names));
    left_out_.clear();
    left_out_span_ = {};
}

/// `var="1 0 0 ..."` of old files.
void Reader::read_old_variations(const pugi::xml_node& node, Map& map) {
    static constexpr std::array<std::string_view, 20> order = {
        "linear", "sinusoidal", "spherical", "swirl",      "horseshoe",   "polar", "handkerchief",
        "heart",  "disc",       "spiral",    "hyperbolic", "diamond",     "ex",    "julia",
        "bent",   "waves",      "fisheye",   "popcorn",    "exponential", "power"};
    const std::vector<double> values = numbers_in(node.attribute("var").value());
    for (std::size_t i = 0; i < values.size() && i < order.size(); ++i)
        if (values[i] != 0) map.variations.emplace_back(order[i], values[i]);
    if (const int only = node.attribute("var1").as_int(-1);
        only >= 0 && only < static_cast<int>(order.size()))
        map.variations.emplace_back(order[static_cast<std::size_t>(only)], 1);
}

std::vector<pugi::xml_node> flames_of(const pugi::xml_document& document) {
    std::vector<pugi::xml_node> flames, open;
    for (const pugi::xml_node& node : document.children())
        open.push_back(node);
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (std::string_view(open[i].name()) == "flame") {
            flames.push_back(open[i]);
            continue;
        }
        for (const pugi::xml_node& node : open[i].children())
            open.push_back(node);
    }
    return flames;
}

} // namespace graftal::flame
