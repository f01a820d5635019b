#include "compiler/import/fractint/system.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/drawn_steps.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

/// The first sixteen of Fractint's palette.
constexpr std::array<std::string_view, 16> ega_names = {
    "black",     "blue",          "green",     "cyan",       "red",         "magenta",
    "brown",     "light_grey",    "dark_grey", "light_blue", "light_green", "light_cyan",
    "light_red", "light_magenta", "yellow",    "white"};

/// The linear light of such a colour, whose bits are blue, green, red and intensity. Brown has less green.
std::string ega_colour(std::size_t number) {
    const bool light = number > 7;
    const auto part = [&](std::size_t bit) {
        return (number & bit) != 0 ? (light ? 1 : 0.4) : (light ? 0.09 : 0);
    };
    return fmt::format("{}, {}, {}", part(4), number == 6 ? 0.09 : part(2), part(1));
}

class FractintTurtle {
  public:
    /// `fractint` must outlive this.
    explicit FractintTurtle(const FractintSystem& fractint)
        : angle_(fractint.angle),
          two_headings_(uses_any(fractint.system, "DM\\/") && uses_any(fractint.system, "FG+-|")) {}

    bool two_headings() const { return two_headings_; }

    std::string same(const std::string& symbol) const {
        if (symbol == "G") return "f";
        if (symbol == "D") return two_headings_ ? "D" : "F";
        if (symbol == "M") return two_headings_ ? "M" : "f";
        return std::string_view("F+-[]").find(symbol) != std::string_view::npos ? symbol : std::string();
    }

    std::optional<std::string> told(const LSystemModule& module) const {
        const std::string number = module.parameters.empty() ? "" : module.parameters[0];
        switch (module.symbol[0]) {
        case '\\':
            return turn('+', number);
        case '/':
            return turn('-', number);
        case '|': // the largest turn of at most 180 degrees; Fractint turns it to the right, reversed or not
            return angle_ % 2 == 0 ? "|" : fmt::format("-({}*360/{})", angle_ / 2, angle_);
        case '!':
            return "@F";
        case '@':
            return fmt::format("@S({})", number);
        case 'C':
            return fmt::format(";({})", number);
        case '<':
            return std::string(std::stoul(number), ';');
        case '>':
            return std::string(std::stoul(number), ',');
        default:
            return std::nullopt;
        }
    }

  private:
    std::string turn(char sign, const std::string& degrees) const {
        return two_headings_ ? fmt::format("@X{}({})@X", sign, degrees)
                             : fmt::format("{}({})", sign, degrees);
    }

    int angle_;
    bool two_headings_;
};

} // namespace

Translation write_fractint_system(const ForeignFile& file, const ForeignModel& model,
                                  FractintSystem fractint) {
    LSystem& system = fractint.system;
    const FractintTurtle turtle(fractint);
    const bool coloured = uses_any(system, "C<>");
    CpfgDialect dialect;
    dialect.same = [&](const std::string& symbol) { return turtle.same(symbol); };
    dialect.told = [&](const LSystemModule& module, Span) { return turtle.told(module); };
    // Fractint's turtle heads to the right at first, and its colour is the last of sixteen.
    dialect.start = turtle.two_headings() ? "-(90)@X-(90)@X " : "-(90)";
    if (coloured) {
        dialect.start += ";(15)";
        dialect.head.line("background: 0, 0, 0");
        for (std::size_t i = 0; i < ega_names.size(); ++i)
            dialect.head.line(fmt::format("material {} {{ color: {}  ambient: 1  diffuse: 0 }}", ega_names[i],
                                          ega_colour(i)));
        dialect.settings.line(fmt::format("  colors {}", fmt::join(ega_names, ", ")));
    }
    dialect.settings.line(fmt::format("  angle 360/{}{}", fractint.angle, remark_text(fractint.angle_remark)),
                          fractint.angle_span);
    const auto [steps, lines] = steps_to_draw(system, "FD");
    dialect.settings.line(
        fmt::format("  steps {}{}", steps,
                    remark_text(fmt::format("Fractint's order; with this it draws {:.0f} lines", lines))));
    if (turtle.two_headings()) {
        if (uses_any(system, "D")) dialect.ending.line("  interpret D -> @XF@X   # along the second heading");
        if (uses_any(system, "M")) dialect.ending.line("  interpret M -> @Xf@X");
    }
    system.head_comments.insert(
        system.head_comments.begin(),
        {fmt::format("{}: an L-system of Fractint", comment_text(model.name)), model.span});
    return write_dialect(file, std::move(system), model, dialect);
}

} // namespace graftal
