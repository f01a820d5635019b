#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/lpy/python.h"
#include "compiler/import/lpy/ways.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int most_python_nested = 100;      ///< parentheses and functions
constexpr std::size_t most_atoms = 10'000;   ///< numbers and names of an expression, with those of functions
constexpr std::size_t most_letters = 50'000; ///< of an expression of ours

struct Failed {};

} // namespace

std::string lpy_own_name(const std::string& name) {
    return name == "step" || name == "age" ? name + "_" : name;
}

/// Reads one expression by recursive descent. Its operators bind in Python as they do in ours.
class LpyExpression {
  public:
    LpyExpression(LpyPython& python, std::string_view text, Span span, const LpyValues& values)
        : python_(python), text_(text), span_(span), values_(values) {}

    std::string read() {
        try {
            std::string out = choice();
            skip();
            if (at_ < text_.size())
                fail(fmt::format("'{}' has no translation", comment_text(text_.substr(at_, 20))));
            return out;
        } catch (const Failed&) {
            return "0";
        }
    }

  private:
    [[noreturn]] void fail(const std::string& message) {
        python_.complain_(span_, message);
        throw Failed();
    }

    void skip() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
            ++at_;
    }

    bool take(std::string_view sign) {
        skip();
        if (!text_.substr(at_).starts_with(sign)) return false;
        const std::size_t end = at_ + sign.size();
        if (is_cpfg_name(sign[0]) && end < text_.size() && is_cpfg_name(text_[end])) return false;
        at_ = end;
        return true;
    }

    std::string checked(std::string text) {
        if (text.size() > most_letters) fail("an expression becomes too long");
        return text;
    }

    std::string choice() {
        if (++depth_ > most_python_nested) fail("an expression is nested too deeply");
        std::string value = either();
        if (take("if")) {
            const std::string condition = either();
            if (!take("else")) fail("'if' without 'else' in an expression");
            value = fmt::format("choose({}, {}, {})", condition, value, choice());
        }
        --depth_;
        return checked(std::move(value));
    }

    std::string either() {
        std::string value = both();
        while (take("or"))
            value += " || " + both();
        return value;
    }

    std::string both() {
        std::string value = negation();
        while (take("and"))
            value += " && " + negation();
        return value;
    }

    std::string negation() {
        int count = 0;
        while (take("not"))
            ++count;
        std::string value = comparison();
        return count % 2 == 0 ? value : fmt::format("!({})", value);
    }

    /// `a < b < c` asks both.
    std::string comparison() {
        std::string left = sum(), all;
        int count = 0;
        for (;; ++count) {
            std::string sign;
            for (const std::string_view known : {"==", "!=", "<=", ">=", "<>", "<", ">"})
                if (sign.empty() && take(known)) sign = known == "<>" ? "!=" : known;
            if (sign.empty()) break;
            std::string right = sum();
            all += fmt::format("{}{} {} {}", count == 0 ? "" : " && ", left, sign, right);
            left = std::move(right);
        }
        skip();
        if (take("in") || take("is")) fail("'in' and 'is' have no translation");
        return checked(count == 0 ? left : count == 1 ? all : "(" + all + ")");
    }

    std::string sum() {
        std::string value = product();
        for (;;) {
            if (take("+"))
                value += " + " + product();
            else if (take("-"))
                value += " - " + product();
            else
                return checked(std::move(value));
        }
    }

    std::string product() {
        std::string value = factor();
        for (;;) {
            if (take("//"))
                value = fmt::format("floor({}/{})", value, factor());
            else if (take("/"))
                value += "/" + factor();
            else if (text_.substr(at_).starts_with("**"))
                fail("'**' has no translation here");
            else if (take("*"))
                value += "*" + factor();
            else if (take("%"))
                value = fmt::format("mod(mod({0}, {1}) + ({1}), {1})", value,
                                    factor()); // Python's has the sign of the divisor
            else
                return checked(std::move(value));
            skip();
        }
    }

    std::string factor() {
        std::string signs;
        for (;;)
            if (take("-"))
                signs = signs.empty() ? "-" : "";
            else if (!take("+"))
                break;
        std::string value = atom();
        if (take("**")) {
            if (++depth_ > most_python_nested) fail("an expression is nested too deeply");
            value += "^" + factor();
            --depth_;
        }
        return signs.empty() ? value : fmt::format("(-{})", value);
    }

    std::string atom() {
        skip();
        if (++python_.work_ > most_atoms) fail("an expression is too long");
        if (at_ == text_.size()) fail("an expression ends too soon");
        const char c = text_[at_];
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return number();
        if (c == '(') {
            ++at_;
            std::string inside = choice();
            if (take(",")) fail("a tuple has no translation");
            if (!take(")")) fail("a '(' is not closed");
            return "(" + inside + ")";
        }
        if (!is_cpfg_name(c))
            fail(fmt::format("'{}' has no translation", comment_text(text_.substr(at_, 20))));
        std::string name = word();
        while (at_ < text_.size() && text_[at_] == '.') {
            if (!python_.modules_.contains(name))
                fail(fmt::format("'{}' is an object of Python, which has no translation", name));
            ++at_;
            name = word();
        }
        skip();
        if (at_ < text_.size() && text_[at_] == '(') return call(name);
        if (at_ < text_.size() && text_[at_] == '[') fail(fmt::format("'{}[...]' has no translation", name));
        return value_of(name);
    }

    std::string number() {
        const LeadingNumber read = leading_number(text_.substr(at_, 40));
        if (read.length == 0) fail("expected a number");
        std::string out(text_.substr(at_, read.length));
        at_ += read.length;
        if (at_ < text_.size() && (is_cpfg_name(text_[at_]) || text_[at_] == '.'))
            fail(fmt::format("'{}' is no number", comment_text(out + text_[at_])));
        if (out.find_first_of("xX") != std::string::npos) return shortest(read.value);
        if (out.ends_with('.')) out += '0';
        return out;
    }

    std::string word() {
        std::string name(cpfg_name_at(text_, at_));
        at_ += name.size();
        return name;
    }

    std::string value_of(const std::string& name) {
        if (const auto own = values_.find(name); own != values_.end()) return own->second;
        if (python_.global_.contains(name)) return lpy_own_name(name);
        if (name == "pi") return name;
        if (name == "True") return "1";
        if (name == "False") return "0";
        if (const auto known = python_.unknown_.find(name); known != python_.unknown_.end())
            fail(fmt::format("'{}' is Python that has no translation", name));
        fail(fmt::format("'{}' has no value", name));
    }

    std::vector<std::string> arguments() {
        std::vector<std::string> all;
        ++at_;
        if (take(")")) return all;
        do {
            if (take("*")) fail("'*' before an argument has no translation");
            all.push_back(choice());
            skip();
            if (at_ < text_.size() && text_[at_] == '=') fail("named arguments have no translation");
        } while (take(","));
        if (!take(")")) fail("a '(' is not closed");
        return all;
    }

    std::string call(const std::string& name) {
        const auto own = python_.functions_.find(name);
        if (own == python_.functions_.end() && python_.unknown_.contains(name))
            fail(fmt::format("'{}' is Python that has no translation", name));
        const std::vector<std::string> given = arguments();
        if (own != python_.functions_.end()) return checked(called(name, own->second, given));
        if (const std::optional<std::string> known = built_in(name, given)) return *known;
        fail(fmt::format("the function '{}' has no translation", name));
    }

    /// A function of the file, written out.
    std::string called(const std::string& name, const LpyPython::Function& function,
                       const std::vector<std::string>& given) {
        LpyValues values;
        for (std::size_t i = 0; i < function.parameters.size(); ++i) {
            const auto& [parameter, otherwise] = function.parameters[i];
            if (i >= given.size() && otherwise.empty())
                fail(fmt::format("'{}' asks for {} values", name, function.parameters.size()));
            values[parameter] =
                i < given.size() ? "(" + given[i] + ")" : python_.expression(otherwise, span_, {});
        }
        if (given.size() > function.parameters.size())
            fail(fmt::format("'{}' asks for {} values", name, function.parameters.size()));
        if (python_.depth_ >= most_python_nested / 4) fail(fmt::format("'{}' calls itself", name));
        ++python_.depth_;
        const std::optional<std::string> result =
            LpyWays(python_, LpyWays::Of::function).result(function.lines, values);
        --python_.depth_;
        if (!result) fail(fmt::format("the function '{}' is Python that has no translation", name));
        return "(" + *result + ")";
    }

    /// Angles are in radians in Python, and in degrees in ours.
    static std::optional<std::string> built_in(const std::string& name,
                                               const std::vector<std::string>& given) {
        const std::size_t count = given.size();
        constexpr std::string_view same[] = {"sqrt", "exp", "floor", "ceil", "abs"};
        if (count == 1 && std::ranges::find(same, name) != std::end(same))
            return fmt::format("{}({})", name, given[0]);
        if (count == 1 && (name == "sin" || name == "cos" || name == "tan"))
            return fmt::format("{}(({})*180/pi)", name, given[0]);
        if (count == 1 && (name == "asin" || name == "acos" || name == "atan"))
            return fmt::format("({}({})*pi/180)", name, given[0]);
        if (count == 2 && name == "atan2") return fmt::format("(atan2({}, {})*pi/180)", given[0], given[1]);
        if (count == 1 && name == "radians") return fmt::format("(({})*pi/180)", given[0]);
        if (count == 1 && name == "degrees") return fmt::format("(({})*180/pi)", given[0]);
        if (count == 1 && name == "fabs") return fmt::format("abs({})", given[0]);
        if (count == 1 && name == "float") return fmt::format("({})", given[0]);
        if (count == 1 && name == "int") return fmt::format("(sign({0})*floor(abs({0})))", given[0]);
        if (count == 1 && name == "round") return fmt::format("floor({} + 0.5)", given[0]);
        if (count == 1 && name == "log") return fmt::format("log({})", given[0]);
        if (count == 2 && name == "log") return fmt::format("(log({})/log({}))", given[0], given[1]);
        if (count == 2 && name == "pow") return fmt::format("pow({}, {})", given[0], given[1]);
        if (count >= 2 && (name == "min" || name == "max")) {
            std::string all = given[0];
            for (std::size_t i = 1; i < count; ++i)
                all = fmt::format("{}({}, {})", name, all, given[i]);
            return all;
        }
        if (count == 0 && name == "random") return "random(0, 1)";
        if (count == 2 && name == "uniform") return fmt::format("random({}, {})", given[0], given[1]);
        if (count == 2 && name == "randint")
            return fmt::format("floor(random({}, {} + 1))", given[0], given[1]);
        if (count == 2 && (name == "gauss" || name == "normalvariate"))
            return fmt::format("normal({}, {})", given[0], given[1]);
        if (count == 0 && name == "getIterationNb") return "(step - 1)";
        return std::nullopt;
    }

    LpyPython& python_;
    std::string_view text_;
    Span span_;
    const LpyValues& values_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

std::string LpyPython::expression(std::string_view text, Span span, const LpyValues& values) {
    if (depth_ == 0) work_ = 0;
    return LpyExpression(*this, text, span, values).read();
}

void LpyPython::name_value(const std::string& name, std::string_view value, Span span) {
    unknown_.erase(name);
    const bool again = !global_.insert(name).second;
    bool good = !again;
    const LpyComplaint loud = std::exchange(complain_, [&](Span, const std::string&) { good = false; });
    global_.erase(name); // not within its own value
    std::string text = expression(value, span, {});
    complain_ = loud;
    std::erase_if(numbers_, [&](const Number& number) { return number.name == lpy_own_name(name); });
    const auto is_step = [](std::string_view word) { return word == "step"; };
    if (!good || is_random(text) || names_any(text, is_step)) {
        unknown_.emplace(name, span);
        return;
    }
    global_.insert(name);
    numbers_.push_back({lpy_own_name(name), std::move(text), span});
}

void LpyPython::name_unknown(const std::string& name, Span span) {
    std::erase_if(numbers_, [&](const Number& number) { return number.name == lpy_own_name(name); });
    global_.erase(name);
    unknown_.emplace(name, span);
}

void LpyPython::add_function(const LpyLine& line) {
    const std::string_view text = line.text;
    const std::size_t open = text.find('(');
    if (open == std::string_view::npos || open < 4) return;
    const std::size_t length = find_outside(text.substr(open + 1), ")");
    if (length == std::string_view::npos) return;
    const std::size_t colon = text.find(':', open + 1 + length);
    if (colon == std::string_view::npos) return;
    Function function{{}, line.below, line.span};
    for (const std::string_view one : split_outside(text.substr(open + 1, length))) {
        const std::size_t equal = std::min(one.find('='), one.size());
        function.parameters.emplace_back(trimmed(one.substr(0, equal)),
                                         trimmed(one.substr(std::min(equal + 1, one.size()))));
    }
    if (const std::string_view body = trimmed(text.substr(colon + 1)); !body.empty())
        function.lines = {LpyLine{std::string(body), "", line.span, line.indent + 1, {}}};
    functions_.insert_or_assign(std::string(trimmed(text.substr(4, open - 4))), std::move(function));
}

void LpyPython::add_import(std::string_view text) {
    if (!text.starts_with("import ")) return;
    text.remove_prefix(7);
    while (!trimmed(text).empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        std::string_view one = trimmed(text.substr(0, comma));
        if (const std::size_t as = one.find(" as "); as != std::string_view::npos)
            one = trimmed(one.substr(as + 4));
        modules_.emplace(one);
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
}

std::vector<LpyPath> LpyPython::ways(const std::vector<LpyLine>& lines, const LpyValues& values) {
    return LpyWays(*this, LpyWays::Of::rule).all(lines, values);
}

} // namespace graftal
