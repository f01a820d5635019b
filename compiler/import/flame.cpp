#include "compiler/import/flame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "compiler/import/flame_variations.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"
#include "compiler/import/own_words.h"
#include "compiler/import/spectral_radius.h"
#include "compiler/support/number.h"
#include "compiler/support/srgb.h"

namespace graftal {

namespace flame {

constexpr std::size_t most_maps = 1000;

struct Map {
    Affine pre, post;
    std::vector<std::pair<std::string, double>> variations;
    double weight = 0;
    double colour = 0, speed = 0.5;
    double opacity = 1;
    std::vector<double> chaos; ///< factors of the weights of the maps that follow
    std::string name;
    Span span;

    bool is_affine() const {
        return std::ranges::all_of(variations,
                                   [](const auto& one) { return one.first.starts_with("linear"); });
    }
    /// Of an affine map.
    Affine whole() const {
        double factor = 0;
        for (const auto& one : variations)
            factor += one.second;
        Affine scaled = pre;
        scaled.linear = factor * pre.linear;
        scaled.translation = factor * pre.translation;
        Affine map = post * scaled;
        const Mat3& m = map.linear; // z by the mean of x and y, as the rows of .rifs
        map.linear[2] = {0, 0, std::sqrt(std::abs(m[0][0] * m[1][1] - m[1][0] * m[0][1]))};
        return map;
    }
};

struct Flame {
    std::vector<Map> maps;
    std::optional<Map> last; ///< finalxform
    std::array<std::array<double, 3>, 256> palette{};
    std::vector<bool> has_colour = std::vector<bool>(256);
    int symmetry = 1;
    Span symmetry_span;
    std::optional<std::array<double, 2>> centre;
    double scale = 0, width = 0;
    std::array<double, 3> background{};
};

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

class Reader {
  public:
    explicit Reader(const ForeignFile& file) : file_(file) {}

    /// Without an error if there is one.
    const pugi::xml_document* document() {
        const std::string_view text = file_.text();
        const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
        if (result) return &document_;
        const auto at = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(result.offset, 0, static_cast<std::ptrdiff_t>(text.size())));
        file_.diagnostics.error(file_.span(at, at), fmt::format("this is no XML: {}", result.description()));
        return nullptr;
    }

    Span span(const pugi::xml_node& node) const {
        const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
        return file_.span(at, std::min(at + std::string_view(node.name()).size(), file_.text().size()));
    }

    std::optional<Flame> read(const pugi::xml_node& node) {
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
                    file_.diagnostics.error(span(child),
                                            fmt::format("a flame has at most {} maps", most_maps));
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

  private:
    static void set_colour(Flame& flame, int index, Rgb encoded) {
        const auto part = [](double v) { return std::clamp(v, 0.0, 1.0); };
        flame.palette[static_cast<std::size_t>(index)] = {part(encoded.r), part(encoded.g), part(encoded.b)};
        flame.has_colour[static_cast<std::size_t>(index)] = true;
    }

    /// Six hexadecimal digits a colour, or eight with two in front.
    static void read_palette(const pugi::xml_node& node, Flame& flame) {
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

    Affine coefficients(const pugi::xml_attribute& attribute, Span place) {
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

    Map read_map(const pugi::xml_node& node) {
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
        if (map.variations.empty() && !node.attribute("coefs").empty())
            map.variations.emplace_back("linear", 1);
        return map;
    }

    /// `var="1 0 0 ..."` of old files.
    void read_old_variations(const pugi::xml_node& node, Map& map) {
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

    const ForeignFile& file_;
    pugi::xml_document document_;
};

/// All flames of a document, at any depth of `<flames>`.
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

std::vector<ForeignModel> models(const ForeignFile& file) {
    Reader reader(file);
    const pugi::xml_document* const document = reader.document();
    std::vector<ForeignModel> found;
    if (!document) return found;
    std::set<std::string> names;
    for (const pugi::xml_node& flame : flames_of(*document)) {
        std::string name = comment_text(flame.attribute("name").value());
        if (name.empty()) name = fmt::format("flame{}", found.size() + 1);
        if (!names.insert(name).second) name = fmt::format("{}_{}", name, found.size() + 1);
        names.insert(name);
        found.push_back({name, reader.span(flame)});
    }
    return found;
}

// Text

class Writer {
  public:
    Writer(const ForeignFile& file, const ForeignModel& model, Flame flame)
        : file_(file), name_(own_name(model.name)), flame_(std::move(flame)) {
        add_symmetry();
        fill_palette();
        out_.line(comment(model.name + ", a flame"));
    }

    std::optional<Translation> write() {
        double sum = 0;
        for (const Map& map : flame_.maps)
            sum += map.weight;
        for (Map& map : flame_.maps)
            map.weight /= sum;
        const bool affine =
            std::ranges::all_of(flame_.maps, &Map::is_affine) && (!flame_.last || flame_.last->is_affine());
        for (const Map& map : flame_.maps)
            if (map.opacity < 1)
                file_.diagnostics.warning(map.span,
                                          "'opacity' changes nothing here: the map draws what it makes");
        const Map* const growing = affine ? find_growing() : nullptr;
        if (affine && !growing)
            write_maps();
        else if (!write_orbit(growing))
            return std::nullopt;
        return std::move(out_);
    }

  private:
    static std::string comment(const std::string& words) { return "# " + comment_text(words); }
    static std::string own_name(const std::string& name) {
        const std::string plain = plain_name(name);
        return is_own_word(plain) ? plain + "_flame" : plain;
    }
    static std::string number(double value) { return shortest(value); }

    void add_symmetry() {
        if (flame_.symmetry == 1 || flame_.symmetry == 0) return;
        const int turns = std::min(std::abs(flame_.symmetry), 100);
        double sum = 0;
        for (const Map& map : flame_.maps)
            sum += map.weight;
        const auto add = [&](const Affine& whole) {
            Map map;
            map.pre = whole;
            map.variations = {{"linear", 1}};
            map.weight = sum;
            map.speed = 0;
            map.span = flame_.symmetry_span;
            flame_.maps.push_back(std::move(map));
        };
        for (int i = 1; i < turns; ++i)
            add(Affine::rotate({0, 0, 1}, 360.0 * i / turns));
        if (flame_.symmetry < 0) add(Affine::scale({-1, 1, 1}));
    }

    /// Colours between those that are given.
    void fill_palette() {
        std::optional<std::size_t> before;
        for (std::size_t i = 0; i < 256; ++i) {
            if (!flame_.has_colour[i]) continue;
            for (std::size_t j = before ? *before + 1 : 0; j < i; ++j) {
                const double share =
                    before ? static_cast<double>(j - *before) / static_cast<double>(i - *before) : 1;
                for (std::size_t k = 0; k < 3; ++k)
                    flame_.palette[j][k] =
                        (1 - share) * flame_.palette[before.value_or(i)][k] + share * flame_.palette[i][k];
            }
            before = i;
        }
        for (std::size_t j = before ? *before + 1 : 256; j < 256; ++j)
            flame_.palette[j] = flame_.palette[*before];
        has_palette_ = before.has_value();
    }

    /// A map whose powers do not shrink; of two together.
    const Map* find_growing() const {
        constexpr double limit = 1 - 1e-7;
        for (const Map& map : flame_.maps)
            if (spectral_radius(map.whole().linear) >= limit) return &map;
        if (flame_.maps.size() > 64) return nullptr;
        for (std::size_t i = 0; i < flame_.maps.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (spectral_radius(flame_.maps[i].whole().linear * flame_.maps[j].whole().linear) >= limit &&
                    may_follow(i, j) && may_follow(j, i))
                    return &flame_.maps[i];
        return nullptr;
    }

    double chaos(std::size_t from, std::size_t to) const {
        const std::vector<double>& factors = flame_.maps[from].chaos;
        return to < factors.size() ? std::max(0.0, factors[to]) : 1;
    }

    bool may_follow(std::size_t from, std::size_t to) const {
        return chaos(from, to) * flame_.maps[to].weight > 0;
    }

    std::string tint(const Map& map) const {
        if (!has_palette_ || map.speed == 0) return "";
        const std::array<double, 3>& rgb =
            flame_.palette[static_cast<std::size_t>(std::lround(255 * map.colour))];
        const auto linear = [](double v) { return number(std::round(1e5 * linear_from_srgb(v)) / 1e5); };
        return fmt::format("  tint rgb <{}, {}, {}> {}", linear(rgb[0]), linear(rgb[1]), linear(rgb[2]),
                           number(map.speed));
    }

    void write_camera() {
        const std::array<double, 3>& b = flame_.background;
        out_.line(fmt::format("background: {}, {}, {}", number(linear_from_srgb(b[0])),
                              number(linear_from_srgb(b[1])), number(linear_from_srgb(b[2]))));
        if (!flame_.centre || !(flame_.scale > 0) || !(flame_.width > 0)) return;
        const double x = (*flame_.centre)[0], y = (*flame_.centre)[1];
        out_.line(fmt::format(
            "camera {{ orthographic  location: {0},{1},-10  look_at: {0},{1},0  up: 0,-1,0  width: {2} }}"
            "   # y points downwards",
            number(x), number(y), number(flame_.width / flame_.scale)));
    }

    void write_maps() {
        write_camera();
        const bool chaotic =
            std::ranges::any_of(flame_.maps, [](const Map& map) { return !map.chaos.empty(); });
        out_.line(fmt::format("rifs {} {{", name_));
        out_.line("  codes 2d {");
        for (const Map& map : flame_.maps) {
            const Affine whole = map.whole();
            out_.line(fmt::format("    {} {} {} {}  {} {}  {}{}{}", number(whole.linear[0][0]),
                                  number(whole.linear[1][0]), number(whole.linear[0][1]),
                                  number(whole.linear[1][1]), number(whole.translation.x),
                                  number(whole.translation.y), number(map.weight), tint(map),
                                  map.name.empty() ? "" : "   " + comment(map.name)),
                      map.span);
        }
        out_.line("  }");
        if (chaotic) write_chaos();
        out_.line("}");
        if (!flame_.last) return;
        const Affine whole = flame_.last->whole();
        out_.line(fmt::format("main rifs {}_final {{", name_));
        out_.line(
            fmt::format("  map final from {} {{ matrix {}, {}, 0, {},  {}, {}, 0, {},  0, 0, {}, 0{} }}",
                        name_, number(whole.linear[0][0]), number(whole.linear[1][0]),
                        number(whole.translation.x), number(whole.linear[0][1]), number(whole.linear[1][1]),
                        number(whole.translation.y), number(whole.linear[2][2]), tint(*flame_.last)),
            flame_.last->span);
        out_.line("}");
    }

    /// Row i: how likely each map follows map i.
    void write_chaos() {
        out_.line("  follow matrix {   # 'chaos'");
        for (std::size_t i = 0; i < flame_.maps.size(); ++i) {
            double sum = 0;
            for (std::size_t j = 0; j < flame_.maps.size(); ++j)
                sum += chaos(i, j) * flame_.maps[j].weight;
            std::string row = "   ";
            for (std::size_t j = 0; j < flame_.maps.size(); ++j)
                row += " " + number(sum > 0 ? chaos(i, j) * flame_.maps[j].weight / sum : 0);
            out_.line(row, flame_.maps[i].span);
        }
        out_.line("  }");
    }

    bool write_orbit(const Map* growing) {
        bool good = true;
        const auto fail = [&](Span span, std::string message) {
            file_.diagnostics.error(span, std::move(message));
            good = false;
        };
        if (flame_.last)
            fail(flame_.last->span, "a 'finalxform' of a flame that is no limit set is not translated");
        for (const Map& map : flame_.maps)
            if (!map.chaos.empty() &&
                std::ranges::any_of(map.chaos, [](double factor) { return factor != 1; }))
                fail(map.span, "'chaos' in a flame that is no limit set is not translated");
        if (growing)
            file_.diagnostics
                .warning(growing->span,
                         "this map does not shrink, alone or with another, so the flame has no limit set")
                .with_hint("the model is an orbit: 'graftal points' draws it");
        out_.line(fmt::format("orbit {} {{", name_));
        out_.line("  start 0.1, 0.2");
        for (const Map& map : flame_.maps)
            good = write_map(map) && good;
        out_.line("}");
        return good;
    }

    bool write_map(const Map& map) {
        // Variations with two branches make maps for each choice.
        std::vector<std::vector<std::pair<double, Formula>>> choices = {{}};
        for (const auto& [variation, weight] : map.variations) {
            const std::vector<Formula> formulas = formulas_of(variation, map.pre);
            if (formulas.empty()) {
                file_.diagnostics.error(map.span,
                                        fmt::format("the variation '{}' is not translated", variation));
                return false;
            }
            std::vector<std::vector<std::pair<double, Formula>>> more;
            for (const auto& choice : choices)
                for (const Formula& formula : formulas) {
                    more.push_back(choice);
                    more.back().emplace_back(weight, formula);
                }
            choices = std::move(more);
        }
        for (const auto& choice : choices) {
            out_.line("  map {", map.span);
            const Affine& pre = map.pre;
            out_.line(fmt::format("    let u = ({}) * x + ({}) * y + ({})", number(pre.linear[0][0]),
                                  number(pre.linear[1][0]), number(pre.translation.x)));
            out_.line(fmt::format("    let v = ({}) * x + ({}) * y + ({})", number(pre.linear[0][1]),
                                  number(pre.linear[1][1]), number(pre.translation.y)));
            if (!map.is_affine()) {
                out_.line("    let r2 = u*u + v*v");
                out_.line("    let r = sqrt(r2)");
                out_.line("    let theta = pi / 180 * atan2(u, v)");
            }
            std::string x, y;
            for (const auto& [weight, formula] : choice) {
                const std::string sign = x.empty() ? "" : " + ";
                x += fmt::format("{}({}) * ({})", sign, number(weight), formula.x);
                y += fmt::format("{}({}) * ({})", sign, number(weight), formula.y);
            }
            const Affine& post = map.post;
            if (post == Affine()) {
                out_.line("    x = " + x);
                out_.line("    y = " + y);
            } else {
                out_.line("    let p = " + x);
                out_.line("    let q = " + y);
                out_.line(fmt::format("    x = ({}) * p + ({}) * q + ({})", number(post.linear[0][0]),
                                      number(post.linear[1][0]), number(post.translation.x)));
                out_.line(fmt::format("    y = ({}) * p + ({}) * q + ({})", number(post.linear[0][1]),
                                      number(post.linear[1][1]), number(post.translation.y)));
            }
            out_.line(fmt::format("    probability {}{}",
                                  number(map.weight / static_cast<double>(choices.size())), tint(map)));
            out_.line("  }");
        }
        return true;
    }

    const ForeignFile& file_;
    std::string name_;
    Flame flame_;
    bool has_palette_ = false;
    Translation out_{.extension = "rifs"};
};

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel& model) {
    Reader reader(file);
    const pugi::xml_document* const document = reader.document();
    if (!document) return std::nullopt;
    for (const pugi::xml_node& node : flames_of(*document)) {
        if (reader.span(node) != model.span) continue;
        std::optional<Flame> flame = reader.read(node);
        if (!flame) return std::nullopt;
        return Writer(file, model, std::move(*flame)).write();
    }
    return std::nullopt;
}

bool recognises(std::string_view text) {
    return text.find("<flame") != std::string_view::npos;
}

} // namespace flame

Importer flame_importer() {
    static constexpr std::string_view endings[] = {"flame", "flam3"};
    return {.format = "fractal flame",
            .endings = endings,
            .recognises = flame::recognises,
            .models = flame::models,
            .translate = flame::translate};
}

} // namespace graftal
