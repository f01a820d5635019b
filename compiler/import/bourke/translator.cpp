#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/bourke/bourke.h"
#include "compiler/import/cpfg/dialect.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/drawn_steps.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::string_view parameters_hint =
    "the parameters are angle, angle increment, length, length factor, line width, line width increment and "
    "iterations; a rule is written F -> F+F";

class BourkeTranslator {
  public:
    /// Both must outlive this.
    BourkeTranslator(const ForeignFile& file, const ForeignModel& model)
        : file_(file), model_(model), code_(file) {}

    Translation translate() {
        for (const BourkeLine& line : bourke_lines(file_.text(), model_.span.begin, model_.span.end)) {
            if (file_.diagnostics.full()) break;
            read(line);
        }
        system_.tail_comments = std::move(comments_);
        if (system_.axiom.empty()) error(system_.axiom_span, "the axiom is empty");
        check_numbers();
        give_factors();
        fit(system_.axiom);
        for (LSystemProduction& rule : rules())
            fit(rule.successor);
        return write();
    }

  private:
    struct Number {
        double value = 0;
        Span span;
    };

    std::vector<LSystemProduction>& rules() { return system_.productions[LSystemSection::productions]; }

    Diagnostic& error(Span span, const std::string& message) {
        return file_.diagnostics.error(span, message);
    }
    void warn_once(Span span, const std::string& message) {
        if (said_.insert(message).second) file_.diagnostics.warning(span, message);
    }
    void error_once(Span span, const std::string& message, const char* hint) {
        if (said_.insert(message).second) error(span, message).with_hint(hint);
    }

    void read(const BourkeLine& line) {
        const Span span = file_.span(line.begin, line.value_begin + line.value.size());
        switch (line.kind) {
        case BourkeLineKind::remark:
            comments_.emplace_back(comment_text(line.value), span);
            break;
        case BourkeLineKind::axiom:
            system_.head_comments = std::exchange(comments_, {});
            system_.axiom = string_of(line.value, line.value_begin);
            system_.axiom_span = span;
            break;
        case BourkeLineKind::rule:
            add_rule(line, span);
            break;
        case BourkeLineKind::parameter:
            add_number(line, span);
            break;
        }
    }

    /// The symbols of a text, without its blanks, each with its place.
    LSystemString string_of(std::string_view text, std::size_t begin) {
        LSystemString string;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t from = at;
            for (const char sign : code_.next(text, at, begin)) {
                if (std::isspace(static_cast<unsigned char>(sign))) continue;
                string.push_back({std::string(1, sign), {}, false, file_.span(begin + from, begin + at)});
            }
        }
        return string;
    }

    void add_rule(const BourkeLine& line, Span span) {
        LSystemProduction rule;
        rule.span = span;
        rule.predecessor = string_of(line.name, line.begin);
        rule.successor = string_of(line.value, line.value_begin);
        rule.comments = std::exchange(comments_, {});
        if (rule.predecessor.size() != 1) return void(error(span, "a rule rewrites one symbol"));
        const std::string& symbol = rule.predecessor[0].symbol;
        if (std::string_view("[]{}()").find(symbol) != std::string_view::npos)
            error(rule.predecessor[0].span, fmt::format("a rule for '{}' has no translation", symbol));
        const auto [first, is_new] = rule_spans_.emplace(symbol, span);
        if (!is_new)
            error(span, fmt::format("a second rule for '{}'", symbol))
                .with_note(first->second, "the first is here");
        else
            rules().push_back(std::move(rule));
    }

    void add_number(const BourkeLine& line, Span span) {
        const Span value_span = file_.span(line.value_begin, line.value_begin + line.value.size());
        if (line.parameter == BourkeParameter::unknown) {
            error(span, fmt::format("'{}' is no parameter of Bourke's notes", comment_text(line.name)))
                .with_hint(std::string(parameters_hint));
            return;
        }
        const std::string text = code_.signs(line.value, value_span);
        const LeadingNumber read = leading_number(text);
        std::string_view unit = trimmed(std::string_view(text).substr(read.length));
        if (unit == "\xb0" || unit == "degrees" || unit == "deg") unit = {};
        if (read.length == 0 || !unit.empty() || !std::isfinite(read.value))
            error(value_span,
                  fmt::format("expected a number, found '{}'", comment_text(line.value.substr(0, 40))));
        if (!numbers_.emplace(line.parameter, Number{read.value, value_span}).second)
            error(span, fmt::format("a second '{}'", comment_text(line.name)));
    }

    const Number* number(BourkeParameter parameter) const {
        const auto known = numbers_.find(parameter);
        return known == numbers_.end() ? nullptr : &known->second;
    }
    double value_of(BourkeParameter parameter) const {
        const Number* const known = number(parameter);
        return known ? known->value : 0;
    }

    /// Widths have a meaning beside lengths only.
    bool has_widths() const { return number(BourkeParameter::width) && number(BourkeParameter::length); }

    void check_numbers() {
        const auto above = [&](BourkeParameter parameter, bool or_zero, const char* message) {
            const Number* const known = number(parameter);
            if (known && !(known->value > 0 || (or_zero && known->value == 0))) error(known->span, message);
        };
        above(BourkeParameter::length, false, "a length must be above 0");
        above(BourkeParameter::length_factor, false, "a length factor must be above 0");
        above(BourkeParameter::width, true, "a line width must be 0 or more");
        above(BourkeParameter::steps, true, "the number of iterations must be 0 or more");
        const Number* const width = number(BourkeParameter::width);
        if (width && !has_widths())
            file_.diagnostics.warning(width->span,
                                      "the line width is left out: there is no 'length' beside it");
    }

    /// In the axiom the turning angle is known at each place, so that what it grows by is a factor.
    void give_factors() {
        const double increment = value_of(BourkeParameter::angle_increment);
        if (increment == 0 || !number(BourkeParameter::angle)) return;
        std::vector<double> open;
        double angle_deg = value_of(BourkeParameter::angle);
        for (LSystemModule& module : system_.axiom) {
            if (module.symbol == "[") open.push_back(angle_deg);
            if (module.symbol == "]" && !open.empty()) {
                angle_deg = open.back();
                open.pop_back();
            }
            if (module.symbol != "(" && module.symbol != ")") continue;
            const double next_deg = angle_deg + (module.symbol == ")" ? increment : -increment);
            if (angle_deg == 0)
                error_once(module.span, "the turning angle is 0 here: what follows has no translation", "");
            module.parameters = {shortest(next_deg / angle_deg)};
            angle_deg = next_deg;
        }
    }

    /// Takes out the symbols that change nothing, and reports those that have no meaning without a number.
    void fit(LSystemString& string) {
        std::erase_if(string, [&](const LSystemModule& module) {
            if (rule_spans_.contains(module.symbol)) return false; // one of the model's own, too
            switch (module.symbol[0]) {
            case '#':
            case '!':
                if (has_widths() && number(BourkeParameter::width_increment)) return false;
                warn_once(
                    module.span,
                    "'#' and '!' are left out: they need 'length', 'line width' and 'line width increment'");
                return true;
            case '(':
            case ')':
                if (value_of(BourkeParameter::angle_increment) != 0) return false;
                warn_once(module.span, "'(' and ')' are left out: there is no 'angle increment'");
                return true;
            default:
                return false;
            }
        });
        for (const LSystemModule& module : string)
            check(module);
    }

    void check(const LSystemModule& module) {
        switch (module.symbol[0]) {
        case '+':
        case '-':
        case '(':
        case ')':
            if (!number(BourkeParameter::angle))
                error_once(module.span, "the model has no angle", "add a line such as 'angle = 90'");
            else if (module.parameters.empty() && (module.symbol == "(" || module.symbol == ")"))
                error_once(module.span, "'(' and ')' have a translation in the axiom only",
                           "write turns of their own, such as +(20), in an .lsys");
            break;
        case '<':
        case '>':
            if (!number(BourkeParameter::length_factor))
                error_once(module.span, "the model has no length factor",
                           "add a line such as 'length factor = 1.36'");
            break;
        default:
            break;
        }
    }

    static std::string same(const std::string& symbol) {
        return std::string_view("Ff+-|[]}").find(symbol) == std::string_view::npos ? "" : symbol;
    }

    std::optional<std::string> told(const LSystemModule& module) const {
        const auto factor = [&] { return shortest(value_of(BourkeParameter::length_factor)); };
        const double widening = value_of(BourkeParameter::width_increment);
        switch (module.symbol[0]) {
        case '{':
            return "{."; // the place where it opens is a corner
        case '>':
            return fmt::format("@S({})", factor());
        case '<':
            return fmt::format("@S(1/{})", factor());
        case '#':
            return fmt::format("@I({})", shortest(widening));
        case '!':
            return fmt::format("@I({})", shortest(-widening));
        case '@': // the width is the radius
            return "@W(2)@O@W(1/2)";
        case '&':
            return "@F";
        case '(':
        case ')':
            return module.parameters.empty() ? "" : fmt::format("@A({})", module.parameters[0]);
        default:
            return std::nullopt;
        }
    }

    Translation write() {
        CpfgDialect dialect;
        dialect.same = same;
        dialect.told = [&](const LSystemModule& module, Span) { return told(module); };
        const auto line = [&](const char* word, BourkeParameter parameter) {
            if (const Number* const known = number(parameter))
                dialect.settings.line(fmt::format("  {} {}", word, shortest(known->value)), known->span);
        };
        line("angle", BourkeParameter::angle);
        line("step", BourkeParameter::length);
        if (has_widths()) line("width", BourkeParameter::width);
        if (const Number* const steps = number(BourkeParameter::steps)) {
            dialect.settings.line(fmt::format("  steps {}", shortest(std::floor(steps->value))), steps->span);
        } else {
            const auto [count, lines] = steps_to_draw(system_, "F");
            dialect.settings.line(fmt::format(
                "  steps {}{}", count,
                remark_text(fmt::format("the text has none; with these it draws {:.0f} lines", lines))));
        }
        return write_dialect(file_, std::move(system_), model_, dialect);
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    CodeReader code_;
    LSystem system_;
    LSystemComments comments_;
    std::map<BourkeParameter, Number> numbers_;
    std::map<std::string, Span> rule_spans_; ///< by their symbols
    std::set<std::string> said_;
};

} // namespace

std::optional<Translation> translate_bourke(const ForeignFile& file, const ForeignModel& model) {
    return BourkeTranslator(file, model).translate();
}

} // namespace graftal
