#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/lpy/system.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr double turtle_angle_deg = 60, turtle_radius = 0.1; ///< at the start
constexpr int turtle_colour = 1;

/// The leaf that L-Py draws for `~l`, one long and half as wide, as a polygon.
constexpr std::string_view leaf = "{.+(36.8698976)f(5/12)-(36.8698976)f(1/3)-(36.8698976)f(5/12)"
                                  "-(106.2602047)f(5/12)-(36.8698976)f(1/3)}";

class LpyTurtle {
  public:
    /// Both must outlive this.
    LpyTurtle(const ForeignFile& file, CpfgDialect& dialect) : file_(file), dialect_(dialect) {}

    static std::string same(const std::string& symbol) {
        if (symbol == "f") return "g"; // it leaves no vertex
        if (symbol == "@v") return "$";
        if (symbol.size() == 1 &&
            std::string_view("F+-&^/\\|[]{}.%;,").find(symbol[0]) != std::string_view::npos)
            return symbol;
        constexpr std::string_view known[] = {"@Di", "@Dd", "?P", "?H", "?U", "?L"};
        return std::ranges::find(known, symbol) != std::end(known) ? symbol : std::string();
    }

    std::optional<std::string> told(const LSystemModule& module, Span span) {
        const std::string& symbol = module.symbol;
        const std::vector<std::string>& given = module.parameters;
        const std::size_t count = given.size();
        if (symbol == "F" && count > 1) return tapered(given[0], given[1]);
        if (symbol == "_" || symbol == "!") {
            if (count > 0) return fmt::format("!(2*({}))", given[0]);
            return symbol == "_" ? "@I(2)" : "@I(-2)";
        }
        if (symbol == "@O" || symbol == "@o")
            return count > 0 ? fmt::format("{}(2*({}))", symbol, given[0]) : symbol;
        if (symbol == ";" && count > 1)
            return left_out(symbol, "colours that are no numbers of materials", span);
        if (symbol == "nF" && count > 0)
            return count > 2 ? tapered(given[0], given[2]) : fmt::format("F({})", given[0]);
        if (symbol == "Sweep" && count > 0) {
            warn(span, "'Sweep': the curves of a sweep are left out: it is straight");
            const std::string line = fmt::format("F({})", given[0]);
            return count > 2 ? fmt::format("!(2*({})){}", given[2], line) : line;
        }
        if (symbol == "@B" || symbol == "@b") {
            warn(span, "boxes and quads are drawn as segments");
            return count > 0 ? fmt::format("F({})", given[0]) : "F";
        }
        if (symbol == "@Ts") {
            if (!std::exchange(bends_, true)) {
                dialect_.settings.line("  tropism 0, 1, 0");
                dialect_.settings.line("  bending before moves");
            }
            return fmt::format("T({})", count > 0 ? given[0] : "0");
        }
        // The axes x, y, z of L-Py are our z, x, y.
        if (symbol == "@M" && count == 3) return fmt::format("@M({}, {}, {})", given[1], given[2], given[0]);
        if (symbol == "@R" && count == 3) return fmt::format("@R({}, {}, {})", given[1], given[2], given[0]);
        if (symbol == "@R" && count == 6)
            return fmt::format("@R({}, {}, {}, {}, {}, {})", given[1], given[2], given[0], given[4], given[5],
                               given[3]);
        if (symbol == "~l")
            return count > 0 ? fmt::format("[@Di({}){}]", given[0], leaf) : fmt::format("[{}]", leaf);
        if (symbol == "@Gc" || symbol == "@Ge") {
            warn(span, "generalized cylinders are drawn as their segments");
            return "";
        }
        return without_translation(symbol, span);
    }

  private:
    /// From the width here to that there.
    static std::string tapered(const std::string& length, const std::string& radius) {
        return fmt::format("@GsF({})!(2*({}))@Ge", length, radius);
    }

    std::optional<std::string> without_translation(const std::string& symbol, Span span) {
        constexpr std::pair<std::string_view, const char*> left[] = {
            {"@L", "labels"},
            {"@g", "shapes of Python"},
            {"Frame", "frames"},
            {"Arrow", "arrows"},
            {"SetContour", "contours"},
            {"SectionResolution", "resolutions"},
            {"SetGuide", "guides"},
            {"EndGuide", "guides"},
            {"PositionOnGuide", "guides"},
            {"@2D", "places on the screen"},
            {"@3D", "places on the screen"},
            {"InterpolateColors", "colours between others"}};
        for (const auto& [known, what] : left)
            if (symbol == known) return left_out(symbol, what, span);
        if (symbol.starts_with("Texture") || symbol.starts_with("InterpolateTexture"))
            return left_out(symbol, "textures", span);
        if (symbol[0] == '~') return left_out(symbol, "surfaces that are not in the file", span);
        constexpr std::string_view refused[] = {"@D",           "@h",
                                                "@M",           "@R",
                                                "@Tp",          "LineTo",
                                                "OLineTo",      "LineRel",
                                                "OLineRel",     "MoveRel",
                                                "Pinpoint",     "PinpointRel",
                                                "EulerAngles",  "nF",
                                                "Sweep",        "LeftReflection",
                                                "UpReflection", "HeadingReflection"};
        const bool asks = symbol[0] == '?' && symbol.size() > 1 && same(symbol).empty();
        if (!asks && std::ranges::find(refused, symbol) == std::end(refused)) return std::nullopt;
        file_.diagnostics.error(span, fmt::format("'{}' has no translation with these parameters", symbol));
        return "";
    }

    void warn(Span span, const std::string& message) {
        if (warned_.insert(message).second) file_.diagnostics.warning(span, message);
    }

    std::string left_out(const std::string& symbol, const char* what, Span span) {
        warn(span, fmt::format("'{}': {} are left out", symbol, what));
        return "";
    }

    const ForeignFile& file_;
    CpfgDialect& dialect_;
    std::set<std::string> warned_;
    bool bends_ = false;
};

} // namespace

Translation write_lpy(const ForeignFile& file, const ForeignModel& model, LSystem system) {
    CpfgDialect dialect;
    LpyTurtle turtle(file, dialect);
    dialect.same = LpyTurtle::same;
    dialect.told = [&](const LSystemModule& module, Span span) { return turtle.told(module, span); };
    std::string names;
    for (const Rgb& colour : lpy_colours(file.text())) {
        const std::size_t number = dialect.head.origins.size();
        dialect.head.line(fmt::format("material colour{} {{ color: {}, {}, {} }}", number, shortest(colour.r),
                                      shortest(colour.g), shortest(colour.b)));
        names += fmt::format("{}colour{}", number == 0 ? "" : ", ", number);
    }
    dialect.angle_deg = turtle_angle_deg;
    dialect.start = fmt::format(";({})", turtle_colour);
    dialect.settings.line(fmt::format("  width {}", 2 * turtle_radius));
    dialect.settings.line("  colors " + names);
    if (system.length.empty()) system.length = "1";
    return write_dialect(file, std::move(system), model, dialect);
}

} // namespace graftal
