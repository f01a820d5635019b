#include "compiler/import/cpfg_words.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"

namespace graftal {

int CpfgWords::depth_of(CpfgSection section) const {
    const auto known = system_.depth.find(section);
    return known == system_.depth.end() ? 1 : std::atoi(known->second.substr(0, 9).c_str());
}

std::string CpfgWords::formals(const CpfgString& string) {
    std::string text;
    for (const CpfgModule& module : string) {
        text += name_of(module.symbol);
        if (!module.has_parentheses) continue;
        text += "(";
        for (std::size_t i = 0; i < module.parameters.size(); ++i)
            text += (i == 0 ? "" : ", ") + module.parameters[i];
        text += ")";
    }
    return text;
}

/// The module of ours that has this name in productions.
std::string CpfgWords::name_of(const std::string& symbol) {
    if (symbol.size() > 1) {
        if (symbol[0] == '~') return "Surface_" + symbol.substr(1);
        return symbol;
    }
    const char c = symbol[0];
    if (std::string_view("FfGg+-&^\\/|[]{}.%!;,").find(c) != std::string_view::npos) return symbol;
    std::string name = c == 'T' ? "TT" : symbol_name(c);
    if (name.size() > 1 || !has_production(symbol)) declared_.insert(name);
    return name;
}

bool CpfgWords::has_production(const std::string& symbol) const {
    return std::ranges::any_of(system_.productions, [&](const auto& section) {
        return std::ranges::any_of(section.second, [&](const CpfgProduction& production) {
            return !production.predecessor.empty() && production.predecessor[0].symbol == symbol;
        });
    });
}

/// Whether the homomorphism would draw this module as something else.
bool CpfgWords::is_drawn_otherwise(const CpfgModule& module) const {
    const auto section = system_.productions.find(CpfgSection::homomorphism);
    if (section == system_.productions.end()) return false;
    return std::ranges::any_of(section->second, [&](const CpfgProduction& production) {
        return production.predecessor.size() == 1 && production.predecessor[0].symbol == module.symbol &&
               production.predecessor[0].parameters.size() == module.parameters.size();
    });
}

/// `raw`: no module of the string is drawn as another one.
std::string CpfgWords::text_of(const CpfgString& string, Span span, bool raw) {
    std::string text;
    for (const CpfgModule& module : string)
        text += text_of(module, span, raw && is_drawn_otherwise(module));
    return text;
}

std::string CpfgWords::parameters(const CpfgModule& module, Span span, bool raw) {
    std::string text;
    for (const std::string& parameter : module.parameters)
        text += (text.empty() ? "" : ", ") + names_.expression(parameter, span);
    // The turtle passes over parameters beyond those that it needs, and no production is for so many.
    if (raw && module.parameters.empty()) text = default_parameter(module.symbol, span);
    if (raw && !module.parameters.empty()) text += ", 0";
    return text.empty() ? text : "(" + text + ")";
}

std::string CpfgWords::default_parameter(const std::string& symbol, Span span) {
    if (std::string_view("FfGg").find(symbol) != std::string_view::npos) return "1";
    if (std::string_view("+-&^\\/").find(symbol) != std::string_view::npos)
        return fmt::format("{}", names_.view().angle_deg);
    const bool means_nothing = symbol.size() == 1 && std::isalnum(static_cast<unsigned char>(symbol[0]));
    if (!means_nothing)
        names_.error(span, fmt::format("'{}' in the homomorphism of itself has no translation", symbol));
    return "0";
}

std::string CpfgWords::text_of(const CpfgModule& module, Span span, bool raw) {
    const std::string& symbol = module.symbol;
    if (symbol[0] == '@' && symbol.size() > 1) return directive(module, span);
    if (symbol[0] == '~') return surface(module, span);
    if (symbol == "?" || symbol == "$") {
        names_.error(span, symbol == "?" ? "queries of the turtle or the environment (?) have no translation"
                                         : "sub-L-systems ($) have no translation");
        return "";
    }
    if (symbol == "!" || symbol == "#") return width(module, span);
    if ((symbol == ";" || symbol == ",") && module.parameters.empty()) {
        const int times = std::clamp(names_.view().colour_increment, 0, 255) % 8;
        return std::string(static_cast<std::size_t>(times), symbol[0]);
    }
    if ((symbol == "[" || symbol == "]" || symbol == "{" || symbol == "}") && module.has_parentheses)
        names_.warn_once(span, fmt::format("the parameters of '{}' are left out", symbol));
    if (symbol == "[" || symbol == "]" || symbol == "{" || symbol == "}") return symbol;
    if (symbol == "_" || symbol == "s")
        names_.warn_once(span, fmt::format("'{}' means nothing here", symbol));
    return name_of(symbol) + parameters(module, span, raw);
}

std::string CpfgWords::surface(const CpfgModule& module, Span span) {
    const auto known = names_.view().surfaces.find(module.symbol.size() > 1 ? module.symbol[1] : ' ');
    if (known == names_.view().surfaces.end()) {
        names_.error(span, fmt::format("the view file names no surface for '{}'", module.symbol));
        return "";
    }
    if (module.parameters.size() > 1) {
        names_.error(span, fmt::format("'{}' with a scale for each axis has no translation", module.symbol));
        return "";
    }
    used_surfaces_.insert(known->first);
    names_.warn_once(span, "surfaces have the material of leaves, whatever the colour of the turtle");
    const std::string scale = fmt::format("{}", known->second.scale);
    if (module.parameters.empty()) return fmt::format("~{}({})", surface_name(known->first), scale);
    return fmt::format("~{}({}*({}))", surface_name(known->first), scale,
                       names_.expression(module.parameters[0], span));
}

std::string CpfgWords::surface_name(char letter) {
    return "surface_" + std::string(1, letter);
}

std::string CpfgWords::width(const CpfgModule& module, Span span) {
    if (names_.view().width_in_pixels) {
        names_.warn_once(span, "widths in pixels are left out: lines are as thick as the figure asks");
        return "";
    }
    if (!module.parameters.empty()) return "!" + parameters(module, span, false);
    if (names_.view().width_increment != 0)
        names_.error(span, fmt::format("'{}' without a width, which adds {} to it, has no translation",
                                       module.symbol, names_.view().width_increment));
    return "";
}

std::string CpfgWords::directive(const CpfgModule& module, Span span) {
    constexpr std::string_view same[] = {"@o", "@c", "@O", "@Gs", "@Gc", "@Ge", "@Di", "@Dd"};
    if (std::ranges::find(same, module.symbol) != std::end(same)) {
        const bool cylinder = module.symbol[1] == 'G';
        return module.symbol + (cylinder ? "" : parameters(module, span, false));
    }
    if (module.symbol == "@v") return "$";
    constexpr std::pair<std::string_view, const char*> left_out[] = {
        {"@#", "contours of generalized cylinders are left out: they are round"},
        {"@!", "how many sides a cylinder has is left out: cylinders are round"},
        {"@Gt", "the shapes of generalized cylinders between their points are left out"},
        {"@Gr", "the shapes of generalized cylinders between their points are left out"},
        {"@L", "labels are left out"},
        {"@S", "commands of the shell are left out"},
        {"@;", "colours of back sides are left out"},
        {"@,", "colours of back sides are left out"}};
    for (const auto& [symbol, message] : left_out)
        if (symbol == module.symbol) return names_.warn_once(span, message), "";
    names_.error(span, fmt::format("the directive '{}' has no translation", module.symbol));
    return "";
}

} // namespace graftal
