#include "compiler/import/cpfg/write/words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr std::string_view brackets = "[]{}";

bool is_one_of(const std::string& symbol, std::string_view characters) {
    return symbol.size() == 1 && characters.find(symbol[0]) != std::string_view::npos;
}

} // namespace

CpfgWords::CpfgWords(CpfgNames& names, const LSystem& system) : names_(names), system_(system) {
    for (const auto& [section, productions] : system.productions)
        for (const LSystemProduction& production : productions) {
            if (!production.predecessor.empty()) rewritten_.insert(production.predecessor[0].symbol);
            if (section == LSystemSection::homomorphism && production.predecessor.size() == 1)
                drawn_otherwise_.emplace(production.predecessor[0].symbol,
                                         production.predecessor[0].parameters.size());
            for (const LSystemString* string : {&production.predecessor, &production.left, &production.right})
                for (const LSystemModule& module : *string)
                    mentioned_.insert(module.symbol);
        }
    if (names_.dialect()) find_told();
}

void CpfgWords::find_told() {
    std::set<std::string> symbols = mentioned_;
    WithParameters seen;
    mentioned_.insert(names_.dialect()->drawn_late.begin(), names_.dialect()->drawn_late.end());
    const auto take = [&](const LSystemString& string, Span span) {
        for (const LSystemModule& module : string) {
            if (!seen.emplace(module.symbol, module.parameters.size()).second) continue;
            symbols.insert(module.symbol);
            if (!told_.contains(module.symbol) && names_.dialect()->told(module, span))
                told_.insert(module.symbol);
        }
    };
    take(system_.axiom, system_.axiom_span);
    for (const auto& [section, productions] : system_.productions)
        for (const LSystemProduction& production : productions)
            take(production.successor, production.span);
    has_long_names_ = std::ranges::any_of(symbols, [&](const std::string& symbol) {
        const std::string name = name_in_dialect(symbol);
        const bool stays = !told_.contains(symbol) || is_renamed(symbol);
        return stays && name.size() > 1 && std::ranges::all_of(name, is_cpfg_name);
    });
}

int CpfgWords::depth_of(LSystemSection section) const {
    const auto known = system_.depth.find(section);
    return known == system_.depth.end() ? 1 : std::atoi(known->second.substr(0, 9).c_str());
}

std::string CpfgWords::formals(const LSystemString& string) {
    std::string text;
    for (const LSystemModule& module : string) {
        const std::string name = name_of(module.symbol);
        text += (text.empty() ? "" : " ") + name;
        if (!module.has_parentheses || is_one_of(name, brackets)) continue;
        text += "(";
        for (std::size_t i = 0; i < module.parameters.size(); ++i)
            text += (i == 0 ? "" : ", ") + module.parameters[i];
        text += ")";
    }
    return text;
}

/// Whether productions know the module by another name than the turtle.
bool CpfgWords::is_renamed(const std::string& symbol) const {
    if (!mentioned_.contains(symbol)) return false;
    if (names_.dialect()) return told_.contains(symbol);
    if (symbol[0] == '~' || symbol == "#" || symbol == "_") return true;
    if (symbol == "!") return names_.view().width_in_pixels || names_.view().width_increment != 0;
    if (symbol == ";" || symbol == ",") return names_.view().colour_increment != 1;
    constexpr std::array<std::string_view, 5> same = {"@o", "@c", "@O", "@M", "@v"};
    return symbol.size() > 1 && symbol[0] == '@' && std::ranges::find(same, symbol) == same.end();
}

/// A name that no command of ours has, for a symbol that has no command of ours.
std::string CpfgWords::name_in_dialect(const std::string& symbol) const {
    const std::string same = names_.dialect()->same(symbol);
    if (!same.empty() && !is_renamed(symbol)) return same;
    std::string name;
    if (symbol.size() > 1 && std::ranges::all_of(symbol, is_cpfg_name))
        name = symbol;
    else
        for (const char c : symbol)
            name += symbol_name(c);
    if (is_one_of(name, "FfGgT")) name += name;
    return name;
}

std::string CpfgWords::name_of(const std::string& symbol) {
    std::string name;
    if (const CpfgDialect* const dialect = names_.dialect()) {
        name = name_in_dialect(symbol);
        const bool own = is_renamed(symbol) || dialect->same(symbol).empty();
        if (own && (name.size() > 1 || !rewritten_.contains(symbol))) declared_.insert(name);
        return name;
    }
    if (is_renamed(symbol)) {
        name = symbol[0] == '~' ? "Surface_" : symbol[0] == '@' ? "At_" : symbol_name(symbol[0]);
        for (const char c : std::string_view(symbol).substr(1))
            name += std::isalnum(static_cast<unsigned char>(c)) ? std::string(1, c) : symbol_name(c);
        declared_.insert(name);
        return name;
    }
    if (symbol == "@v") return "$";
    if (symbol.size() > 1) {
        if (std::isalnum(static_cast<unsigned char>(symbol[0]))) declared_.insert(symbol);
        return symbol;
    }
    const char c = symbol[0];
    if (c == '/') return "\\";
    if (c == '\\') return "/";
    if (c == '%') {
        uses_cut_ = true;
        declared_.insert(cut_name);
        return cut_name;
    }
    if (std::string_view("FfGg+-&^|[]{}.!;,").find(c) != std::string_view::npos) return symbol;
    name = c == 'T' ? "TT" : symbol_name(c);
    if (name.size() > 1 || !rewritten_.contains(symbol)) declared_.insert(name);
    return name;
}

std::string CpfgWords::text_of(const LSystemString& string, Span span, Use use) {
    std::string text;
    for (const LSystemModule& module : string) {
        const std::string next = text_of(module, span, use);
        // Letters beside each other may make up a name.
        const bool joins = has_long_names_ && !text.empty() && !next.empty() && is_cpfg_name(text.back()) &&
                           (is_cpfg_name(next[0]) || next[0] == '.');
        text += (joins ? " " : "") + next;
    }
    return text;
}

std::string CpfgWords::text_of(const LSystemModule& module, Span span, Use use) {
    if (use == Use::drawn && module.symbol == "%" && !names_.dialect()) return ""; // cpfg cuts nothing there
    if (use == Use::word && is_renamed(module.symbol)) {
        stand_ins_.insert({module.symbol, module.parameters.size()});
        std::string text = name_of(module.symbol);
        return text + parameters(module, span, false);
    }
    const bool otherwise =
        use == Use::drawn && drawn_otherwise_.contains({module.symbol, module.parameters.size()});
    return own_text_of(module, span, otherwise);
}

std::string CpfgWords::stand_ins(Span span) {
    std::string text;
    for (const auto& [symbol, arity] : stand_ins_) {
        LSystemModule module;
        module.symbol = symbol;
        module.has_parentheses = arity > 0;
        for (std::size_t i = 0; i < arity; ++i)
            module.parameters.push_back(fmt::format("p{}", i + 1));
        const std::string drawn = own_text_of(module, span, false);
        text += fmt::format("{} -> {}\n", formals({module}), drawn.empty() ? "*" : drawn);
    }
    return text;
}

/// `other_arity`: no production of the homomorphism is for this number of parameters. The turtle passes over
/// parameters beyond those that it needs.
std::string CpfgWords::parameters(const LSystemModule& module, Span span, bool other_arity) {
    std::string text;
    for (const std::string& parameter : module.parameters)
        text += (text.empty() ? "" : ", ") + names_.expression(parameter, span);
    if (other_arity) {
        std::size_t arity = module.parameters.size();
        if (arity == 0) {
            text = default_parameter(module.symbol, span);
            ++arity;
        } else {
            text += ", 0";
            ++arity;
        }
        for (; drawn_otherwise_.contains({module.symbol, arity}); ++arity)
            text += ", 0";
    }
    return text.empty() ? text : "(" + text + ")";
}

std::string CpfgWords::default_parameter(const std::string& symbol, Span span) {
    if (is_one_of(symbol, "FfGg")) return "1";
    if (is_one_of(symbol, "+-&^\\/")) return fmt::format("{}", names_.view().angle_deg);
    const bool means_nothing = symbol.size() == 1 && std::isalnum(static_cast<unsigned char>(symbol[0]));
    if (!means_nothing)
        names_.error(span, fmt::format("'{}' in the homomorphism of itself has no translation", symbol));
    return "0";
}

/// The text that tells our turtle what the module tells cpfg's.
std::string CpfgWords::own_text_of(const LSystemModule& module, Span span, bool other_arity) {
    const std::string& symbol = module.symbol;
    if (const CpfgDialect* const dialect = names_.dialect()) {
        if (const std::optional<std::string> told = dialect->told(module, span)) return *told;
        const std::string same = dialect->same(symbol);
        if (is_one_of(same, brackets)) return same;
        return (same.empty() ? name_of(symbol) : same) + parameters(module, span, other_arity);
    }
    if (symbol[0] == '@' && symbol.size() > 1) return directive(module, span);
    if (symbol[0] == '~') return surface(module, span);
    if (symbol[0] == '?') return query(module, span);
    if (symbol == "$") {
        names_.file()
            .diagnostics.error(span, "sub-L-systems ($) have no translation")
            .with_hint("in cpfg '@v' rolls the turtle to the horizontal, as '$' does in ABOP");
        return "";
    }
    if (symbol == "!" || symbol == "#") return width(module, span);
    if (symbol == "_") return elasticity(module, span);
    if ((symbol == ";" || symbol == ",") && module.parameters.empty()) return colour_step(module);
    if (is_one_of(symbol, brackets)) {
        if (module.has_parentheses)
            names_.warn_once(span, fmt::format("the parameters of '{}' are left out", symbol));
        return symbol;
    }
    if (symbol == "\"" || symbol == "'") names_.warn_once(span, fmt::format("'{}' means nothing", symbol));
    return name_of(symbol) + parameters(module, span, other_arity);
}

std::string CpfgWords::colour_step(const LSystemModule& module) const {
    constexpr int colours = 8; // of our list: as many steps lead back
    const int step = names_.view().colour_increment;
    const int times = (step % colours + colours) % colours;
    return std::string(static_cast<std::size_t>(times), module.symbol[0]);
}

std::string CpfgWords::query(const LSystemModule& module, Span span) {
    asks_environment_ = asks_environment_ || module.symbol == "?E";
    if (module.symbol == "?P" || module.symbol == "?H" || module.symbol == "?L" || module.symbol == "?E")
        return module.symbol + parameters(module, span, false);
    if (module.symbol == "?" && !module.has_parentheses) {
        names_.warn_once(span, "'?' means nothing");
        return name_of(module.symbol);
    }
    names_.error(span, module.symbol == "?"
                           ? "sub-L-systems (?) have no translation"
                           : fmt::format("the query '{}' has no translation", module.symbol));
    return "";
}

std::string CpfgWords::surface(const LSystemModule& module, Span span) {
    const auto known = names_.view().surfaces.find(module.symbol.size() > 1 ? module.symbol[1] : ' ');
    if (known == names_.view().surfaces.end()) {
        names_.warn_once(
            span, fmt::format("the view file names no surface for '{}', so it draws nothing", module.symbol));
        return "";
    }
    used_surfaces_.insert(known->first);
    names_.warn_once(span, "surfaces have the material of leaves, whatever the colour of the turtle");
    const std::string scale = fmt::format("{}", known->second.scale);
    if (module.parameters.empty()) return fmt::format("~{}({})", surface_name(known->first), scale);
    std::string scales;
    const std::size_t count = module.parameters.size() < 3 ? 1 : 3;
    for (std::size_t i = 0; i < count; ++i)
        scales += fmt::format("{}{}*({})", i == 0 ? "" : ", ", scale,
                              names_.expression(module.parameters[i], span));
    return fmt::format("~{}({})", surface_name(known->first), scales);
}

std::string CpfgWords::surface_name(char letter) {
    return "surface_" + std::string(1, letter);
}

std::string CpfgWords::width(const LSystemModule& module, Span span) {
    if (names_.view().width_in_pixels) {
        names_.warn_once(span, "widths in pixels are left out: lines are as thick as the figure asks");
        return "";
    }
    if (!module.parameters.empty()) return "!" + parameters(module, span, false);
    const double step = names_.view().width_increment;
    if (step == 0) return "";
    return fmt::format("@I({})", module.symbol == "!" ? -step : step);
}

std::string CpfgWords::elasticity(const LSystemModule& module, Span span) {
    if (module.parameters.empty()) {
        const double step = names_.view().elasticity_increment;
        if (step == 0) return "";
        bends_of_old_ = true;
        return fmt::format("@K({})", step);
    }
    bends_of_old_ = true;
    return "T(" + names_.expression(module.parameters[0], span) + ")";
}

std::string CpfgWords::tropism(const LSystemModule& module, Span span) {
    const std::string number = module.parameters.empty()
                                   ? std::string("1")
                                   : std::string(trimmed(names_.expanded(module.parameters[0], span, true)));
    const auto place = static_cast<std::size_t>(std::strtoul(number.substr(0, 9).c_str(), nullptr, 10));
    const std::vector<CpfgTropism>& known = names_.view().tropisms;
    if (place == 0 || place > known.size()) {
        names_.warn_once(span,
                         fmt::format("'{}' has no tropism of this number, and is left out", module.symbol));
        return "";
    }
    tropisms_.insert(place);
    const std::string value =
        module.parameters.size() < 2 ? "0" : names_.expression(module.parameters[1], span);
    return fmt::format("@T({}, {})", place, value);
}

std::string CpfgWords::directive(const LSystemModule& module, Span span) {
    constexpr std::string_view same[] = {"@o", "@c", "@O", "@Gs", "@Gc", "@Ge", "@Di", "@Dd", "@M"};
    if (std::ranges::find(same, module.symbol) != std::end(same)) {
        const bool cylinder = module.symbol[1] == 'G';
        return module.symbol + (cylinder ? "" : parameters(module, span, false));
    }
    if (module.symbol == "@v") return "$";
    if (module.symbol == "@Ts") return tropism(module, span);
    if (module.symbol == "@R") { // its up is our down
        std::string text;
        for (std::size_t i = 0; i < module.parameters.size() && i < 6; ++i)
            text += fmt::format("{}{}({})", i == 0 ? "" : ", ", i < 3 ? "" : "-",
                                names_.expression(module.parameters[i], span));
        return "@R(" + text + ")";
    }
    constexpr std::pair<std::string_view, const char*> left_out[] = {
        {"@#", "contours of generalized cylinders are left out: they are round"},
        {"@!", "how many sides a cylinder has is left out: cylinders are round"},
        {"@Gt", "the shapes of generalized cylinders between their points are left out"},
        {"@Gr", "the shapes of generalized cylinders between their points are left out"},
        {"@L", "labels are left out"},
        {"@S", "commands of the shell are left out"},
        {"@Tx", "textures are left out"},
        {"@Tf", "'@Tf' and '@Tp' are left out: bent segments keep their twist"},
        {"@Tp", "'@Tf' and '@Tp' are left out: bent segments keep their twist"},
        {"@;", "colours of back sides are left out"},
        {"@,", "colours of back sides are left out"}};
    for (const auto& [symbol, message] : left_out)
        if (symbol == module.symbol) return names_.warn_once(span, message), "";
    names_.error(span, fmt::format("the directive '{}' has no translation", module.symbol));
    return "";
}

} // namespace graftal
