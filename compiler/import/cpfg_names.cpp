#include "compiler/import/cpfg_names.h"

#include <algorithm>
#include <cctype>
#include <functional>

#include <fmt/format.h>

#include "compiler/import/cpfg_expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

bool is_cpfg_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

CpfgNames::CpfgNames(const ForeignFile& file, const CpfgSource& source, const CpfgView& view)
    : file_(file), source_(source), view_(view) {
    find_lets();
}

void CpfgNames::warn_once(Span span, const std::string& message) {
    if (warned_.insert(message).second) file_.diagnostics.warning(span, message);
}

void CpfgNames::find_lets() {
    for (const CpfgMacro& macro : source_.macros) {
        if (macro.parameters || macro.body.empty()) continue;
        std::string_view body = macro.body;
        bool number = true;
        for (std::size_t i = 0; i < body.size() && number;) {
            if (std::isdigit(static_cast<unsigned char>(body[i])) || body[i] == '.') {
                while (i < body.size() && (is_cpfg_name(body[i]) || body[i] == '.'))
                    ++i;
            } else if (is_cpfg_name(body[i])) {
                std::size_t end = i;
                while (end < body.size() && is_cpfg_name(body[end]))
                    ++end;
                const std::string name(body.substr(i, end - i));
                constexpr std::string_view known[] = {"sin", "cos", "tan", "sqrt", "exp", "log"};
                number = lets_.contains(name) || std::ranges::find(known, name) != std::end(known);
                i = end;
            } else {
                number = std::string_view("+-*/^() ").find(body[i]) != std::string_view::npos;
                ++i;
            }
        }
        const bool balanced = std::ranges::count(body, '(') == std::ranges::count(body, ')');
        const bool ends =
            std::isalnum(static_cast<unsigned char>(body.back())) || body.back() == ')' || body.back() == '.';
        if (number && balanced && ends) lets_.insert(macro.name);
    }
}

std::string CpfgNames::expanded(std::string_view text, Span span, bool in_string) {
    const auto chosen = [&](const CpfgMacro& macro) { return in_string || !lets_.contains(macro.name); };
    std::optional<std::string> out = expand_cpfg_macros(text, source_.macros, chosen);
    if (!out) error(span, "the macros here do not end, or make too long a text");
    return out.value_or("");
}

std::string CpfgNames::expression(std::string_view text, Span span) {
    const std::function<std::optional<std::string>(std::string_view)> table_of = [&](std::string_view id) {
        return table_named(id, span);
    };
    const std::function<void(const std::string&)> complain = [&](const std::string& message) {
        error(span, message);
    };
    return translated_cpfg_expression(expanded(text, span, false), table_of, complain);
}

std::optional<std::string> CpfgNames::table_named(std::string_view id, Span span) {
    const std::string number = expanded(id, span, true);
    const auto place = static_cast<std::size_t>(std::strtoul(number.substr(0, 9).c_str(), nullptr, 10));
    if (place == 0 || place > view_.functions.size() ||
        trimmed(number).find_first_not_of("0123456789") != std::string_view::npos) {
        error(span, fmt::format("there is no function {} among those that the view file names",
                                comment_text(number)));
        return std::nullopt;
    }
    used_tables_.insert(place - 1);
    return table_name(place - 1);
}

} // namespace graftal
