#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "compiler/import/flame/parametric.h"
#include "compiler/import/flame/reader.h"
#include "compiler/import/flame/variations.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/own_words.h"
#include "compiler/import/spectral_radius.h"
#include "compiler/support/angle.h"
#include "compiler/support/number.h"

namespace graftal {

namespace flame {

std::vector<ForeignModel> models(const ForeignFile& file) {
    Reader reader(file);
    const pugi::xml_document* const document = reader.document();
    std::vector<ForeignModel> found;
    if (!document) return found;
    std::set<std::string> names;
    for (const pugi::xml_node& flame : flames_of(*document)) {
        std::string name = comment_text(flame.attribute("name").value());
        if (name.empty()) name = fmt::format("flame{}", found.size() + 1);
        std::string free = name;
        for (std::size_t i = found.size() + 1; !names.insert(free).second; ++i)
            free = fmt::format("{}_{}", name, i);
        found.push_back({free, reader.span(flame)});
    }
    return found;
}

// Text

class Writer {
  public:
    Writer(const ForeignFile& file, const ForeignModel& model, Flame flame)
        : file_(file), name_(own_name(model.name, "_flame")), flame_(std::move(flame)) {
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
        return fmt::format("  tint rgb <{}> {}", linear_text(rgb), shortest(map.speed));
    }

    void write_camera() {
        out_.line("background: " + linear_text(flame_.background));
        if (!flame_.centre || !(flame_.scale > 0) || !(flame_.width > 0)) return;
        const double x = (*flame_.centre)[0], y = (*flame_.centre)[1];
        const auto [cosine, sine] = cos_sin_deg(flame_.rotate);
        out_.line(fmt::format(
            "camera {{ orthographic  location: {0},{1},-10  look_at: {0},{1},0  up: {3},{4},0  width: {2} }}"
            "   # y points downwards",
            shortest(x), shortest(y), shortest(flame_.width / flame_.scale), shortest(-sine),
            shortest(-cosine)));
    }

    void write_maps() {
        write_camera();
        const bool chaotic = std::ranges::any_of(flame_.maps, &Map::steers);
        out_.line(fmt::format("rifs {} {{", name_));
        out_.line("  codes 2d {");
        for (const Map& map : flame_.maps) {
            const Affine whole = map.whole();
            out_.line(fmt::format("    {} {} {} {}  {} {}  {}{}{}", shortest(whole.linear[0][0]),
                                  shortest(whole.linear[1][0]), shortest(whole.linear[0][1]),
                                  shortest(whole.linear[1][1]), shortest(whole.translation.x),
                                  shortest(whole.translation.y), shortest(map.weight), tint(map),
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
                        name_, shortest(whole.linear[0][0]), shortest(whole.linear[1][0]),
                        shortest(whole.translation.x), shortest(whole.linear[0][1]),
                        shortest(whole.linear[1][1]), shortest(whole.translation.y),
                        shortest(whole.linear[2][2]), tint(*flame_.last)),
            flame_.last->span);
        out_.line("}");
    }

    /// Row i: the factors of `chaos`, divided by their sum. Random iteration multiplies them by the weights
    /// of the maps, which stand in the rows of codes, as in flam3.
    void write_chaos() {
        out_.line("  follow matrix {   # 'chaos'");
        for (std::size_t i = 0; i < flame_.maps.size(); ++i) {
            double sum = 0;
            for (std::size_t j = 0; j < flame_.maps.size(); ++j)
                sum += chaos(i, j);
            std::string row = "   ";
            for (std::size_t j = 0; j < flame_.maps.size(); ++j)
                row += " " + shortest(sum > 0 ? chaos(i, j) / sum : 0);
            out_.line(row, flame_.maps[i].span);
        }
        out_.line("  }");
    }

    bool write_orbit(const Map* growing) {
        bool good = true;
        if (growing)
            file_.diagnostics
                .warning(growing->span,
                         "this map does not shrink, alone or with another, so the flame has no limit set")
                .with_hint("the model is an orbit: 'graftal points' draws it");
        write_camera();
        out_.line(fmt::format("orbit {} {{", name_));
        out_.line("  start 0.1, 0.2");
        out_.line("  restart 1   # as flam3 does with points that run away or have no value");
        std::vector<std::size_t> branches;
        for (const Map& map : flame_.maps)
            good = write_map(map, branches) && good;
        if (std::ranges::any_of(flame_.maps, &Map::steers)) write_factors(branches);
        if (flame_.last) good = write_last(*flame_.last) && good;
        out_.line("}");
        return good;
    }

    /// Rows of `chaos` for the maps of the orbit; the branches of a flame's map are alike.
    void write_factors(const std::vector<std::size_t>& branches) {
        out_.line("  follow matrix {   # 'chaos'");
        for (std::size_t i = 0; i < branches.size(); ++i) {
            std::string row = "   ";
            for (std::size_t j = 0; j < branches.size(); ++j)
                for (std::size_t branch = 0; branch < branches[j]; ++branch)
                    row += " " + shortest(chaos(i, j));
            for (std::size_t branch = 0; branch < branches[i]; ++branch)
                out_.line(row, flame_.maps[i].span);
        }
        out_.line("  }");
    }

    /// A variation of a map.
    struct Term {
        double weight = 0;
        Formula formula;
        bool first = false; ///< comes_first()
    };
    /// One of the equally likely ways through a map.
    using Way = std::vector<Term>;

    /// Variations with two branches make ways of each. None after an error.
    std::vector<Way> ways_of(const Map& map) const {
        std::vector<Way> ways = {{}};
        int variation_number = 0;
        for (const auto& [variation, weight] : map.variations) {
            const Setting setting{
                .pre = map.pre, .weight = weight, .number = [&](const std::string& name, double otherwise) {
                    const auto known = map.numbers.find(name);
                    return known == map.numbers.end() ? otherwise : known->second;
                }};
            const std::vector<Formula> formulas = formulas_of(variation, setting);
            if (formulas.empty() || ways.size() * formulas.size() > most_branches) {
                file_.diagnostics.error(
                    map.span,
                    fmt::format("the variations of this map, with '{}', have no whole number of branches "
                                "from 1 to {}",
                                variation, most_branches));
                return {};
            }
            const std::string mark = std::to_string(++variation_number);
            std::vector<Way> more;
            for (const Way& way : ways)
                for (const Formula& formula : formulas) {
                    more.push_back(way);
                    more.back().push_back({weight, marked(formula, mark), comes_first(variation)});
                }
            ways = std::move(more);
        }
        return ways;
    }

    /// The formula whose random numbers have names of their own.
    static Formula marked(Formula formula, const std::string& mark) {
        for (std::string* const text : {&formula.x, &formula.y, &formula.draws})
            for (std::size_t at = text->find('#'); at != std::string::npos; at = text->find('#', at))
                text->replace(at, 1, mark);
        return formula;
    }

    /// The weighted sum of the terms, those that come first or the others.
    static std::string sum_of(const Way& way, bool first, std::string Formula::*axis) {
        std::string sum;
        for (const Term& term : way)
            if (term.first == first)
                sum += fmt::format("{}({}) * ({})", sum.empty() ? "" : " + ", shortest(term.weight),
                                   term.formula.*axis);
        return sum;
    }

    /// The lines of one way up to `p` and `q`, its image before the map's `post`.
    void write_way(const Map& map, const Way& way) {
        for (const Term& term : way)
            if (!term.formula.draws.empty()) out_.line("    let " + term.formula.draws);
        const auto before = [&](std::size_t axis, double translation, std::string Formula::*formula) {
            const std::string moved = sum_of(way, true, formula);
            return fmt::format("({}) * x + ({}) * y + ({}){}", shortest(map.pre.linear[0][axis]),
                               shortest(map.pre.linear[1][axis]), shortest(translation),
                               moved.empty() ? "" : " + " + moved);
        };
        out_.line("    let u = " + before(0, map.pre.translation.x, &Formula::x));
        out_.line("    let v = " + before(1, map.pre.translation.y, &Formula::y));
        if (!map.is_affine()) {
            out_.line("    let r2 = u*u + v*v");
            out_.line("    let r = sqrt(r2)");
            out_.line("    let theta = pi / 180 * atan2(u, v)");
        }
        const auto sum_or_zero = [&](std::string Formula::*axis) {
            const std::string sum = sum_of(way, false, axis);
            return sum.empty() ? std::string("0") : sum;
        };
        out_.line("    let p = " + sum_or_zero(&Formula::x));
        out_.line("    let q = " + sum_or_zero(&Formula::y));
    }

    void write_image(const Affine& post) {
        const auto after = [&](std::size_t axis, double translation, const char* unmoved) {
            if (post == Affine()) return std::string(unmoved);
            return fmt::format("({}) * p + ({}) * q + ({})", shortest(post.linear[0][axis]),
                               shortest(post.linear[1][axis]), shortest(translation));
        };
        out_.line("    x = " + after(0, post.translation.x, "p"));
        out_.line("    y = " + after(1, post.translation.y, "q"));
    }

    /// Maps of the orbit, one for each way, whose number is added to `branches`.
    bool write_map(const Map& map, std::vector<std::size_t>& branches) {
        const std::vector<Way> ways = ways_of(map);
        for (const Way& way : ways) {
            out_.line("  map {", map.span);
            write_way(map, way);
            write_image(map.post);
            out_.line(fmt::format("    probability {}{}",
                                  shortest(map.weight / static_cast<double>(ways.size())), tint(map)));
            out_.line("  }");
        }
        branches.push_back(ways.size());
        return !ways.empty();
    }

    /// The block `final`, of what is shown of each point: one map, in which a random number chooses among
    /// ways.
    bool write_last(const Map& map) {
        std::vector<Way> ways = ways_of(map);
        if (ways.empty()) return false;
        Way all = ways.front();
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::string Formula::*const axis : {&Formula::x, &Formula::y}) {
                std::string& text = all[i].formula.*axis;
                for (std::size_t way = 1; way < ways.size(); ++way)
                    text = fmt::format("choose(way < {}, {}, {})", way, text, ways[way][i].formula.*axis);
            }
        out_.line("  final {", map.span);
        if (ways.size() > 1) out_.line(fmt::format("    let way = random(0, {})", ways.size()));
        write_way(map, all);
        write_image(map.post);
        if (const std::string shade = tint(map); !shade.empty()) out_.line("  " + shade);
        out_.line("  }");
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
            .sign = "an element '<flame ...>'",
            .models = flame::models,
            .translation = flame::translate,
            .host = "XML or HTML"};
}

} // namespace graftal
