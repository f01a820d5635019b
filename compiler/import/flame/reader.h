#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "compiler/import/importer.h"
#include "compiler/support/affine.h"
#include "compiler/support/srgb.h"

namespace graftal::flame {

inline constexpr std::size_t most_maps = 1000;

/// A function of a flame.
struct Map {
    Affine pre, post;
    std::vector<std::pair<std::string, double>> variations;
    double weight = 0;
    double colour = 0, speed = 0.5;
    double opacity = 1;
    std::map<std::string, double> numbers; ///< of the variations
    std::vector<double> chaos;             ///< factors of the weights of the maps that follow
    std::string name;
    Span span;

    bool is_affine() const {
        return std::ranges::all_of(variations,
                                   [](const auto& one) { return one.first.starts_with("linear"); });
    }
    bool steers() const {
        return std::ranges::any_of(chaos, [](double factor) { return factor != 1; });
    }
    /// The whole of an affine map.
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

/// A flame, as its file says it.
struct Flame {
    std::vector<Map> maps;
    std::optional<Map> last; ///< finalxform
    std::array<std::array<double, 3>, 256> palette{};
    std::vector<bool> has_colour = std::vector<bool>(256);
    int symmetry = 1;
    Span symmetry_span;
    std::optional<std::array<double, 2>> centre;
    double scale = 0, width = 0; ///< pixels of a unit, and of the picture
    double rotate = 0;           ///< of the picture, in degrees
    std::array<double, 3> background{};
};

/// Reads the flames of a file.
class Reader {
  public:
    explicit Reader(const ForeignFile& file) : file_(file) {}

    /// Null after the error that this is no XML.
    const pugi::xml_document* document();
    Span span(const pugi::xml_node& node) const;
    /// Nothing after an error.
    std::optional<Flame> read(const pugi::xml_node& node);

  private:
    static void set_colour(Flame& flame, int index, Rgb encoded);
    static void read_palette(const pugi::xml_node& node, Flame& flame);
    static void drop_idle_maps(Flame& flame);
    Affine coefficients(const pugi::xml_attribute& attribute, Span place);
    Map read_map(const pugi::xml_node& node);
    void read_variations(const pugi::xml_node& node, Map& map);
    void read_old_variations(const pugi::xml_node& node, Map& map);
    void leave_out(const Span& at, const std::string& attribute);
    void report_left_out();
    const ForeignFile& file_;
    std::set<std::string> left_out_; ///< attributes of the flame that is read, or `curve_*`
    Span left_out_span_;             ///< of the first map that has some
    pugi::xml_document document_;
};

/// All flames of a document, at any depth of `<flames>`.
std::vector<pugi::xml_node> flames_of(const pugi::xml_document& document);

} // namespace graftal::flame
