#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/houdini/system.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Commands of Houdini that are one of ours. Both turtles head up; its up is towards the eye, as our z is.
constexpr std::pair<std::string_view, std::string_view> same_symbols[] = {
    {"F", "F"},  {"f", "f"}, {"G", "G"}, {"+", "-"}, {"-", "+"}, {"&", "&"}, {"^", "^"}, {"\\", "/"},
    {"/", "\\"}, {"|", "|"}, {"%", "%"}, {"[", "["}, {"]", "]"}, {"{", "{"}, {"}", "}"}, {".", "."}};

class HoudiniTurtle {
  public:
    /// All must outlive this.
    HoudiniTurtle(const ForeignFile& file, const HoudiniSystem& houdini, CpfgDialect& dialect)
        : file_(file), houdini_(houdini), dialect_(dialect) {
        for (const LSystemProduction& production : houdini.system.productions.at(LSystemSection::productions))
            if (!production.predecessor.empty()) rewritten_.insert(production.predecessor[0].symbol);
    }

    static std::string same(const std::string& symbol) {
        const auto* const known =
            std::ranges::find(same_symbols, symbol, &std::pair<std::string_view, std::string_view>::first);
        return known == std::end(same_symbols) ? std::string() : std::string(known->second);
    }

    std::optional<std::string> told(const LSystemModule& module, Span span) {
        const std::size_t count = module.parameters.size();
        const auto parameter = [&](double otherwise) {
            return count > 0 ? module.parameters[0] : shortest(otherwise);
        };
        switch (module.symbol[0]) {
        case 'F':
        case 'f':
        case 'G':
            return with_width(module);
        case 'H':
            return count > 0 ? fmt::format("F(({})/2)", parameter(0)) : "@S(1/2)F@S(2)";
        case 'h':
            return count > 0 ? fmt::format("f(({})/2)", parameter(0)) : "@S(1/2)f@S(2)";
        case '*':
            return "/(180)";
        case '"':
            return fmt::format("@S({})", parameter(houdini_.step_scale));
        case '_':
            return fmt::format("@S(1/({}))", parameter(houdini_.step_scale));
        case '!':
            return fmt::format("@W({})", parameter(houdini_.thickness_scale));
        case '?':
            return fmt::format("@W(1/({}))", parameter(houdini_.thickness_scale));
        case ';':
            return fmt::format("@A({})", parameter(houdini_.angle_scale));
        case '@':
            return fmt::format("@A(1/({}))", parameter(houdini_.angle_scale));
        case 'T': // one bend by an arc in degrees, which a move without length carries out
            if (!std::exchange(bends_, true)) {
                dialect_.settings.line("  tropism 0, -1, 0");
                dialect_.settings.line("  bending after moves");
            }
            return fmt::format("T(({})*pi/180)g(0)T(0)", parameter(houdini_.gravity));
        case '~': {
            const std::string most = parameter(180);
            return fmt::format("+(random(-({0}), {0}))&(random(-({0}), {0}))/(random(-({0}), {0}))", most);
        }
        case '$':
            if (count < 3) return "$";
            return fmt::format("@R({}, {}, {}, 0, 1, 0)", module.parameters[0], module.parameters[1],
                               module.parameters[2]);
        case 'J':
        case 'K':
        case 'M':
            return left_out(module, span, "the geometry of an input is not in the text, and is left out");
        case '\'':
        case '#':
            return left_out(module, span, "places in a texture are left out");
        case 'g':
            return count > 0 ? left_out(module, span, "groups are left out") : std::nullopt;
        default:
            return std::nullopt;
        }
    }

  private:
    /// The width belongs to this segment alone.
    static std::optional<std::string> with_width(const LSystemModule& module) {
        if (module.symbol[0] == 'f' || module.parameters.size() < 2) return std::nullopt;
        return fmt::format("[!({1})G({0})]{2}({0})", module.parameters[0], module.parameters[1],
                           module.symbol[0] == 'F' ? "f" : "g");
    }

    /// Nothing for a symbol that rules rewrite: it is one of the model's own.
    std::optional<std::string> left_out(const LSystemModule& module, Span span, const char* message) {
        if (rewritten_.contains(module.symbol)) return std::nullopt;
        if (warned_.insert(message).second)
            file_.diagnostics.warning(span, fmt::format("'{}': {}", module.symbol, message));
        return "";
    }

    const ForeignFile& file_;
    const HoudiniSystem& houdini_;
    CpfgDialect& dialect_;
    std::set<std::string> rewritten_;
    std::set<std::string> warned_;
    bool bends_ = false;
};

} // namespace

Translation write_houdini(const ForeignFile& file, const ForeignModel& model, HoudiniSystem houdini) {
    CpfgDialect dialect;
    HoudiniTurtle turtle(file, houdini, dialect);
    dialect.same = HoudiniTurtle::same;
    dialect.told = [&](const LSystemModule& module, Span span) { return turtle.told(module, span); };
    dialect.drawn_late = {"~"};
    dialect.angle_deg = houdini.angle_deg;
    if (houdini.thickness) dialect.settings.line(fmt::format("  width {}", *houdini.thickness));
    dialect.settings.line("  step " + shortest(houdini.step));
    return write_dialect(file, houdini.system, model, dialect);
}

} // namespace graftal
