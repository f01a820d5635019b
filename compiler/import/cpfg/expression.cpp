#include "compiler/import/cpfg/expression.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr int most_nested_expressions = 200;

class ExpressionWriter {
  public:
    ExpressionWriter(const CpfgCalls& calls, const std::function<void(const std::string&)>& complain)
        : calls_(calls), complain_(complain) {}

    std::string write(std::string_view text, int depth = 0) {
        if (depth > most_nested_expressions) {
            if (!said_) complain_("an expression is nested too deeply");
            said_ = true;
            return "0";
        }
        text = trimmed(text);
        const std::size_t question = find_outside(text, "?");
        if (question == std::string_view::npos) return plain(text, depth);
        std::size_t colon = question, open = 1;
        while (open > 0) {
            colon = find_outside(text, "?:", colon + 1);
            if (colon == std::string_view::npos) {
                complain_("'?' without ':'");
                return "0";
            }
            open += text[colon] == '?' ? 1 : -1;
        }
        return fmt::format("choose({}, {}, {})", write(text.substr(0, question), depth + 1),
                           write(text.substr(question + 1, colon - question - 1), depth + 1),
                           write(text.substr(colon + 1), depth + 1));
    }

  private:
    /// Without `?` outside of parentheses.
    std::string plain(std::string_view text, int depth) {
        std::string out;
        for (std::size_t i = 0; i < text.size();) {
            const char c = text[i];
            if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
                do
                    out += text[i++];
                while (i < text.size() && (is_cpfg_name(text[i]) || text[i] == '.'));
            } else if (is_cpfg_name(c)) {
                const std::string_view name = cpfg_name_at(text, i);
                i += name.size();
                const std::size_t next = text.find_first_not_of(' ', i);
                if (next != std::string_view::npos && text[next] == '(')
                    out += call(name, text, i = next, depth);
                else
                    out += name;
            } else if (c == '(') {
                const std::string_view inside = parentheses(text, i);
                out += "(" + write(inside, depth + 1) + ")";
            } else if (text.substr(i).starts_with("<>")) {
                out += "!=";
                i += 2;
            } else if (c == '"' || c == '{' || c == '&') {
                if (text.substr(i).starts_with("&&")) {
                    out += "&&";
                    i += 2;
                    continue;
                }
                complain_(fmt::format("'{}' has no translation", c));
                return "0";
            } else {
                out += c;
                ++i;
            }
        }
        return out;
    }

    /// The text between the parenthesis at `i` and its end; moves `i` past that end.
    std::string_view parentheses(std::string_view text, std::size_t& i) {
        const std::size_t begin = i + 1, end = end_of_parentheses(text, i);
        const bool closed = end != std::string_view::npos;
        if (!closed) complain_("a '(' is not closed");
        i = closed ? end : text.size();
        return text.substr(begin, i - begin - (closed ? 1 : 0));
    }

    std::string call(std::string_view name, std::string_view text, std::size_t& i, int depth) {
        const std::string_view inside = parentheses(text, i);
        std::vector<std::string_view> arguments = split_outside(inside);
        if (arguments.empty()) arguments.emplace_back();
        std::vector<std::string> each;
        std::string written;
        for (const std::string_view argument : arguments) {
            each.push_back(write(argument, depth + 1));
            written += (written.empty() ? "" : ", ") + each.back();
        }
        if (const std::optional<std::string> known = calls_(name, arguments, each)) return *known;
        if (name == "ran") return fmt::format("random(0, {})", written);
        if (name == "nran") return fmt::format("normal({})", written);
        if (name == "fabs") return fmt::format("abs({})", written);
        if (name == "trunc") return fmt::format("floor({} + 0.5)", written);
        constexpr std::string_view same[] = {"sin",  "cos", "tan", "asin",  "acos", "atan", "atan2",
                                             "sqrt", "exp", "log", "floor", "ceil", "sign"};
        if (std::ranges::find(same, name) == std::end(same))
            complain_(fmt::format("the function '{}' has no translation", name));
        return fmt::format("{}({})", name, written);
    }

    const CpfgCalls& calls_;
    const std::function<void(const std::string&)>& complain_;
    bool said_ = false;
};

} // namespace

std::size_t find_outside(std::string_view text, std::string_view characters, std::size_t begin) {
    int depth = 0;
    for (std::size_t i = begin; i < text.size(); ++i) {
        if (depth == 0 && characters.find(text[i]) != std::string_view::npos) return i;
        depth += (text[i] == '(') - (text[i] == ')');
        depth = std::max(depth, 0);
    }
    return std::string_view::npos;
}

std::vector<std::string_view> split_outside(std::string_view text, bool squares_count) {
    std::vector<std::string_view> parts;
    if (trimmed(text).empty()) return parts;
    int round = 0, square = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const char c = i < text.size() ? text[i] : ',';
        round = std::max(0, round + (c == '(') - (c == ')'));
        if (squares_count) square += (c == '[') - (c == ']');
        if (i < text.size() && (c != ',' || round > 0 || square > 0)) continue;
        parts.push_back(trimmed(text.substr(begin, i - begin)));
        begin = i + 1;
    }
    return parts;
}

std::size_t end_of_parentheses(std::string_view text, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        depth += (text[i] == '(') - (text[i] == ')');
        if (depth == 0) return i + 1;
    }
    return std::string_view::npos;
}

bool is_cpfg_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::string_view cpfg_name_at(std::string_view text, std::size_t begin) {
    std::size_t end = begin;
    while (end < text.size() && is_cpfg_name(text[end]))
        ++end;
    return text.substr(begin, end - begin);
}

bool is_cpfg_parameter(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, is_cpfg_name) &&
           !std::isdigit(static_cast<unsigned char>(text[0]));
}

std::string translated_cpfg_expression(std::string_view text, const CpfgCalls& calls,
                                       const std::function<void(const std::string&)>& complain) {
    return ExpressionWriter(calls, complain).write(text);
}

} // namespace graftal
