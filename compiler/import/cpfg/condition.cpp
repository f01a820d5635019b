#include "compiler/import/cpfg/condition.h"

#include <array>
#include <cctype>
#include <cmath>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr int most_nested_conditions = 100;

/// Reads a condition by precedence climbing; numbers may have fractions.
class ConditionReader {
  public:
    explicit ConditionReader(std::string_view text) : text_(text) {}

    std::optional<double> read() {
        const double value = level(0, 0);
        skip();
        if (!good_ || at_ != text_.size()) return std::nullopt;
        return value;
    }

  private:
    static constexpr std::array<std::array<std::string_view, 4>, 6> operators = {
        {{"||"}, {"&&"}, {"==", "!="}, {"<=", ">=", "<", ">"}, {"+", "-"}, {"*", "/", "%"}}};

    void skip() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
            ++at_;
    }

    bool accept(std::string_view word) {
        skip();
        if (word.empty() || !text_.substr(at_).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

    double level(std::size_t precedence, int depth) {
        if (precedence == operators.size()) return unary(depth);
        double left = level(precedence + 1, depth);
        for (bool found = true; found && good_;) {
            found = false;
            for (const std::string_view op : operators[precedence])
                if (!found && accept(op)) {
                    found = true;
                    const bool decided = (op == "||" && left != 0) || (op == "&&" && left == 0);
                    unread_ += decided ? 1 : 0;
                    left = combined(op, left, level(precedence + 1, depth));
                    unread_ -= decided ? 1 : 0;
                }
        }
        return left;
    }

    double combined(std::string_view op, double a, double b) {
        if (op == "||") return a != 0 || b != 0;
        if (op == "&&") return a != 0 && b != 0;
        if (op == "==") return a == b;
        if (op == "!=") return a != b;
        if (op == "<=") return a <= b;
        if (op == ">=") return a >= b;
        if (op == "<") return a < b;
        if (op == ">") return a > b;
        if (op == "+") return a + b;
        if (op == "-") return a - b;
        if (op == "*") return a * b;
        if (b != 0) return op == "/" ? a / b : std::fmod(a, b);
        good_ = good_ && unread_ > 0;
        return 0;
    }

    double unary(int depth) {
        if (depth > most_nested_conditions) good_ = false;
        if (!good_) return 0;
        if (accept("!")) return unary(depth + 1) == 0;
        if (accept("-")) return -unary(depth + 1);
        if (accept("+")) return unary(depth + 1);
        if (accept("(")) {
            const double value = level(0, depth + 1);
            good_ = good_ && accept(")");
            return value;
        }
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                      text_[at_] == '_' || text_[at_] == '.'))
            ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        good_ = good_ && !word.empty();
        if (!good_ || !(std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '.')) return 0;
        return leading_number(word).value;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool good_ = true;
    int unread_ = 0; ///< right sides, one in the other, whose value C would not ask for
};

} // namespace

std::optional<double> cpfg_condition(std::string_view text) {
    return ConditionReader(text).read();
}

} // namespace graftal
