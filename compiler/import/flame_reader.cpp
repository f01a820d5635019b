#include "compiler/import/flame_reader.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "compiler/import/flame_variations.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"

namespace graftal::flame {

namespace {

std::vector<double> numbers_in(std::string_view text) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (true) {
        at = text.find_first_not_of(" \t\r\n,", at);
        if (at == std::string_view::npos) return numbers;
        const std::size_t end = std::min(text.find_first_of(" \t\r\n,", at), text.size());
        const std::optional<double> value = parse_number(text.substr(at, end - at));
        numbers.push_back(value && std::abs(*value) <= 1e50 ? *value : 0);
        at = end;
    }
}

} // namespace

const pugi::xml_document* Reader::document() {
    const std::string_view text = file_.text();
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
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
    flame.scale = node.attribute("scale").as_double();
    const std::vector<double> background = numbers_in(node.attribute("background").value());
    if (background.size() == 3)
        for (std::size_t i = 0; i < 3; ++i)
            flame.background[i] = std::clamp(background[i], 0.0, 1.0);
    for (const pugi::xml_node& child : node.children()) {
        const std::string_view name = child.name();
        if (name == "xform" || name == "finalxform") {
            Map map = read_map(child);
            if (name == "finalxform")
                flame.last = std::move(map);
            else if (map.weight > 0 || map.weight != map.weight)
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
    if (flame.maps.empty())
        file_.diagnostics.error(span(node), "this flame has no maps ('xform') with a weight");
    if (file_.diagnostics.error_count() > errors) return std::nullopt;
    return flame;
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
    const std::vector<double> n = numbers_in(attribute.value());
    if (n.size() != 6) {
        file_.diagnostics.error(place, fmt::format("'{}' takes six numbers", attribute.name()));
        return map;
    }
    map.linear[0] = {n[0], n[1], 0};
    map.linear[1] = {n[2], n[3], 0};
    map.translation = {n[4], n[5], 0};
    return map;
}

Map Reader::read_map(const pugi::xml_node& node) {
    static const std::set<std::string_view> plain = {"weight",
                                                     "color",
                                                     "symmetry",
                                                     "color_speed",
                                                     "coefs",
                                                     "post",
                                                     "chaos",
                                                     "opacity",
                                                     "animate",
                                                     "name",
                                                     "plotmode",
                                                     "var",
                                                     "density",
                                                     "var_color",
                                                     "pulsation",
                                                     "slider",
                                                     "motion_frequency",
                                                     "motion_function",
                                                     "motion_offset"};
    Map map;
    map.span = span(node);
    map.pre = coefficients(node.attribute("coefs"), map.span);
    map.post = coefficients(node.attribute("post"), map.span);
    map.weight = node.attribute("weight").as_double(node.attribute("density").as_double(0));
    map.weight = std::clamp(map.weight, 0.0, 1e6);
    map.colour = std::clamp(numbers_in(node.attribute("color").value()).empty()
                                ? 0.0
                                : numbers_in(node.attribute("color").value())[0],
                            0.0, 1.0);
    if (node.attribute("symmetry")) map.speed = (1 - node.attribute("symmetry").as_double()) / 2;
    if (node.attribute("color_speed")) map.speed = node.attribute("color_speed").as_double(0.5);
    map.speed = std::clamp(map.speed, 0.0, 1.0);
    map.opacity = node.attribute("opacity").as_double(1);
    map.chaos = numbers_in(node.attribute("chaos").value());
    map.name = node.attribute("name").value();
    if (std::string_view(node.attribute("plotmode").value()) == "off") map.opacity = 0;
    for (const pugi::xml_attribute& attribute : node.attributes()) {
        const std::string_view name = attribute.name();
        const double value = attribute.as_double();
        if (plain.contains(name) || value == 0) continue;
        if (is_variation(name))
            map.variations.emplace_back(name, std::clamp(value, -1e6, 1e6));
        else if (name.find('_') == std::string_view::npos)
            file_.diagnostics.error(map.span, fmt::format("the variation '{}' is not translated", name));
        // What is left are parameters of variations, which stand or fall with these.
    }
    read_old_variations(node, map);
    if (map.variations.empty() && !node.attribute("coefs").empty()) map.variations.emplace_back("linear", 1);
    return map;
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
