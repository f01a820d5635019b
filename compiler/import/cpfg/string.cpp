#include "compiler/import/cpfg/string.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

/// All macros outside of parentheses; inside them those that are no numbers.
std::string expanded_string(std::string_view text, CpfgNames& names, Span span) {
    const std::vector<CpfgMacro>& macros = names.source().macros;
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t open = std::min(text.find('(', i), text.size());
        const std::size_t close = std::min(end_of_parentheses(text, open), text.size());
        // A macro with arguments takes its parentheses along.
        std::size_t name = open;
        while (name > i && is_cpfg_name(text[name - 1]))
            --name;
        const auto macro = std::ranges::find(macros, text.substr(name, open - name), &CpfgMacro::name);
        if (macro != macros.end() && macro->parameters) {
            out += names.expanded(text.substr(i, name - i), span, true);
            out += names.expanded(text.substr(name, close - name), span, true);
        } else {
            out += names.expanded(text.substr(i, open - i), span, true);
            out += names.expanded(text.substr(open, close - open), span, false);
        }
        i = close;
    }
    return out;
}

void skip_blanks(std::string_view text, std::size_t& i) {
    std::size_t next = i;
    while (next < text.size() && text[next] == ' ')
        ++next;
    if (next < text.size() && text[next] == '(') i = next;
}

void take_parameters(std::string_view text, std::size_t& i, LSystemModule& module, CpfgNames& names,
                     Span span) {
    if (i >= text.size() || text[i] != '(') return;
    module.has_parentheses = true;
    const std::size_t begin = i + 1, end = end_of_parentheses(text, i);
    i = std::min(end, text.size());
    if (end == std::string_view::npos) {
        names.error(span, fmt::format("the '(' after '{}' is not closed", module.symbol));
        return;
    }
    for (const std::string_view parameter : split_outside(text.substr(begin, end - begin - 1)))
        module.parameters.emplace_back(parameter);
}

} // namespace

LSystemString read_cpfg_string(std::string_view given, CpfgNames& names, Span span) {
    const std::string text = expanded_string(given, names, span);
    LSystemString string;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == ' ' || c == '\t') {
            ++i;
            continue;
        }
        LSystemModule module;
        module.symbol = c;
        ++i;
        // Blanks do not count.
        if (c == '@' || c == '~') i = std::min(text.find_first_not_of(" \t", i), text.size());
        const bool queries =
            c == '?' && i < text.size() && std::string_view("PHLUQE").find(text[i]) != std::string_view::npos;
        if ((c == '@' || c == '~' || queries) && i < text.size()) module.symbol += text[i++];
        skip_blanks(text, i);
        take_parameters(text, i, module, names, span);
        constexpr std::string_view longer = "GPTDbm";
        if (c == '@' && module.symbol.size() == 2 &&
            longer.find(module.symbol[1]) != std::string_view::npos && !module.has_parentheses &&
            i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]))) {
            module.symbol += text[i++];
            skip_blanks(text, i);
            take_parameters(text, i, module, names, span);
        }
        string.push_back(std::move(module));
    }
    return string;
}

} // namespace graftal
