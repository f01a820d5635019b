#include "compiler/import/houdini/rule.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

bool is_gap(char c) {
    return std::isspace(static_cast<unsigned char>(c));
}

/// A symbol and the text of each of its parameters.
struct Written {
    char symbol;
    std::vector<std::string_view> parameters;
};

/// Nothing where a parenthesis is not closed, or stands behind no symbol.
std::optional<std::vector<Written>> modules_of(std::string_view text) {
    std::vector<Written> modules;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i++];
        if (is_gap(c)) continue;
        if (c == '(' || c == ')') return std::nullopt;
        Written& module = modules.emplace_back(Written{c, {}});
        while (i < text.size() && is_gap(text[i]))
            ++i;
        if (i == text.size() || text[i] != '(') continue;
        const std::size_t begin = i + 1;
        i = end_of_parentheses(text, i);
        if (i == std::string_view::npos) return std::nullopt;
        module.parameters = split_outside(text.substr(begin, i - 1 - begin));
    }
    return modules;
}

/// Where the '=' stands that is no comparison.
std::size_t find_arrow(std::string_view text) {
    for (std::size_t at = find_outside(text, "="); at != std::string_view::npos;
         at = find_outside(text, "=", at + 1)) {
        if (text.substr(at).starts_with("==")) {
            ++at;
            continue;
        }
        if (at == 0 || std::string_view("<>!").find(text[at - 1]) == std::string_view::npos) return at;
    }
    return std::string_view::npos;
}

} // namespace

std::string HoudiniRules::expression(std::string_view text, Span span, const std::set<std::string>& names,
                                     bool first) {
    std::string known;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
            do
                known += text[i++];
            while (i < text.size() && (is_cpfg_name(text[i]) || text[i] == '.'));
        } else if (is_cpfg_name(c)) {
            const std::string name(cpfg_name_at(text, i));
            i += name.size();
            const std::size_t next = text.find_first_not_of(' ', i);
            const bool calls = next != std::string_view::npos && text[next] == '(';
            if (calls || names.contains(name)) {
                known += name;
            } else if (name == "t") {
                known += first ? "0" : "(step - 1)";
            } else if (name == "b" || name == "c" || name == "d") {
                values_.insert(name);
                known += name;
            } else {
                file_.diagnostics.error(
                    span, fmt::format("'{}' is no parameter here: what Houdini keeps under this name "
                                      "has no translation",
                                      name));
                return "0";
            }
        } else if (c == '&' || c == '|') {
            known += std::string(2, c);
            i += text.substr(i + 1).starts_with(c) ? 2 : 1;
        } else if (is_gap(c) || std::string_view("+-*/%^<>=!(),").find(c) != std::string_view::npos) {
            known += is_gap(c) ? ' ' : c;
            ++i;
        } else {
            file_.diagnostics.error(span, fmt::format("'{}' has no translation in an expression",
                                                      comment_text(std::string_view(&c, 1))));
            return "0";
        }
    }
    const CpfgCalls calls = [&](std::string_view name, std::span<const std::string_view>,
                                std::span<const std::string> written) -> std::optional<std::string> {
        const std::size_t count = written.size();
        if (name == "rand" && count == 1) return "random(0, 1)";
        if (name == "int" && count == 1) return fmt::format("floor({})", written[0]);
        if (name == "abs" && count == 1) return fmt::format("abs({})", written[0]);
        if (name == "if" && count == 3)
            return fmt::format("choose({}, {}, {})", written[0], written[1], written[2]);
        if ((name == "min" || name == "max" || name == "pow") && count == 2)
            return fmt::format("{}({}, {})", name, written[0], written[1]);
        return std::nullopt;
    };
    const std::function<void(const std::string&)> complain = [&](const std::string& message) {
        file_.diagnostics.error(span, message);
    };
    return translated_cpfg_expression(known, calls, complain);
}

LSystemString HoudiniRules::string(std::string_view text, Span span, const std::set<std::string>& names,
                                   bool first) {
    LSystemString string;
    const std::optional<std::vector<Written>> modules = modules_of(text);
    if (!modules) {
        file_.diagnostics.error(span, "parentheses close the parameters of one symbol");
        return string;
    }
    for (const Written& written : *modules) {
        if (written.symbol == '`') {
            file_.diagnostics.error(span, "an expression of Houdini in backquotes has no translation");
            break;
        }
        LSystemModule& module = string.emplace_back();
        module.symbol = written.symbol;
        // The name of an attribute is no number.
        const bool named = written.symbol == 'a' && !written.parameters.empty();
        for (const std::string_view parameter : written.parameters)
            if (!named) module.parameters.push_back(expression(parameter, span, names, first));
        module.has_parentheses = !module.parameters.empty();
        if (file_.diagnostics.full()) break;
        if (named) string.pop_back();
        if (named) file_.diagnostics.warning(span, "'a': attributes of points are left out");
    }
    return string;
}

/// A parameter that is a number asks for that value.
LSystemString HoudiniRules::formals(std::string_view text, Span span, std::set<std::string>& names,
                                    std::string& condition) {
    LSystemString string;
    const std::optional<std::vector<Written>> modules = modules_of(text);
    if (!modules) file_.diagnostics.error(span, "parentheses close the parameters of one symbol");
    if (!modules) return string;
    for (const Written& written : *modules) {
        LSystemModule& module = string.emplace_back();
        module.symbol = written.symbol;
        for (const std::string_view parameter : written.parameters) {
            std::string name(parameter);
            if (!is_cpfg_parameter(name)) {
                name = fmt::format("p{}", names.size() + 1);
                condition += fmt::format("{}{} == ({})", condition.empty() ? "" : " && ", name,
                                         expression(parameter, span, {}, false));
            }
            if (!names.insert(name).second)
                file_.diagnostics.error(span, fmt::format("'{}' is a parameter twice", name));
            module.parameters.push_back(std::move(name));
        }
        module.has_parentheses = !module.parameters.empty();
    }
    return string;
}

LSystemProduction HoudiniRules::production(std::string_view text, Span span) {
    LSystemProduction production;
    production.span = span;
    std::size_t arrow = find_arrow(text);
    const bool drawn = arrow == std::string_view::npos; // people write '->', too
    if (drawn) arrow = text.find("->");
    if (arrow == std::string_view::npos) {
        file_.diagnostics.error(span, "a rule is written symbol=replacement")
            .with_hint("before '=' may stand contexts and a condition: l<A(x)>r:x<3=F(x)");
        return production;
    }
    const std::string_view head = text.substr(0, arrow), tail = text.substr(arrow + (drawn ? 2 : 1));
    const std::size_t colon = std::min(find_outside(head, ":"), head.size());
    std::string_view left = head.substr(0, colon);
    std::set<std::string> names;
    std::string condition;
    if (const std::size_t less = find_outside(left, "<"); less != std::string_view::npos) {
        production.left = formals(left.substr(0, less), span, names, condition);
        left.remove_prefix(less + 1);
    }
    const std::size_t more = std::min(find_outside(left, ">"), left.size());
    production.predecessor = formals(left.substr(0, more), span, names, condition);
    if (more < left.size()) production.right = formals(left.substr(more + 1), span, names, condition);
    if (production.predecessor.size() != 1) file_.diagnostics.error(span, "a rule rewrites one symbol");
    if (colon < head.size() && !trimmed(head.substr(colon + 1)).empty()) {
        const std::string asked = expression(head.substr(colon + 1), span, names, false);
        condition = condition.empty() ? asked : fmt::format("{} && ({})", condition, asked);
    }
    production.condition = condition;
    const std::size_t chance = std::min(find_outside(tail, ":"), tail.size());
    production.successor = string(tail.substr(0, chance), span, names, false);
    if (chance < tail.size() && !trimmed(tail.substr(chance + 1)).empty())
        production.probability = expression(tail.substr(chance + 1), span, names, false);
    return production;
}

} // namespace graftal
