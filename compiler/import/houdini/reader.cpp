#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/houdini/fields.h"
#include "compiler/import/houdini/rule.h"
#include "compiler/import/houdini/system.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr double new_generations = 7;    ///< of a node whose text does not say how many
constexpr std::size_t most_arities = 16; ///< of a symbol

class HoudiniReader {
  public:
    HoudiniReader(const ForeignFile& file, const ForeignModel& model)
        : file_(file), model_(model), code_(file), rules_(file) {}

    std::optional<HoudiniSystem> read() {
        const std::size_t errors = file_.diagnostics.error_count();
        system().length = shortest(new_generations);
        for (const HoudiniLine& line : houdini_lines(file_.text(), model_.span.begin, model_.span.end)) {
            if (file_.diagnostics.full()) break;
            read(line);
        }
        name_values();
        fit_arities();
        rest_of_chances();
        if (system().axiom.empty()) file_.diagnostics.error(model_.span, "the premise is empty");
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return std::move(houdini_);
    }

  private:
    LSystem& system() { return houdini_.system; }
    std::vector<LSystemProduction>& productions() {
        return system().productions[LSystemSection::productions];
    }

    void read(const HoudiniLine& line) {
        const Span span = file_.span(line.begin, line.begin + line.value.size());
        if (line.field == HoudiniField::remark) {
            comments_.emplace_back(comment_text(line.value), span);
            return;
        }
        const auto number = [&] { return number_in(line.value, span); };
        switch (line.field) {
        case HoudiniField::premise:
            system().head_comments = std::exchange(comments_, {});
            system().axiom = rules_.string(code_.signs(line.value, span), span, {}, true);
            system().axiom_span = span;
            break;
        case HoudiniField::rule:
            productions().push_back(rules_.production(code_.signs(line.value, span), span));
            productions().back().comments = std::exchange(comments_, {});
            break;
        case HoudiniField::generations:
            system().length = shortest(std::floor(number()));
            system().length_span = span;
            break;
        case HoudiniField::angle:
            houdini_.angle_deg = number();
            break;
        case HoudiniField::angle_scale:
            houdini_.angle_scale = number();
            break;
        case HoudiniField::step:
            houdini_.step = number();
            break;
        case HoudiniField::step_scale:
            houdini_.step_scale = number();
            break;
        case HoudiniField::thickness:
            houdini_.thickness = number();
            break;
        case HoudiniField::thickness_scale:
            houdini_.thickness_scale = number();
            break;
        case HoudiniField::gravity:
            houdini_.gravity = number();
            break;
        case HoudiniField::value_b:
            values_["b"] = number();
            break;
        case HoudiniField::value_c:
            values_["c"] = number();
            break;
        case HoudiniField::value_d:
            values_["d"] = number();
            break;
        case HoudiniField::ignore:
            ignore(code_.signs(line.value, span), span);
            break;
        case HoudiniField::seed:
            system().seed = shortest(std::abs(std::floor(number())));
            system().seed_span = span;
            break;
        default:
            file_.diagnostics.warning(span, "this parameter is left out");
            break;
        }
    }

    double number_in(std::string_view text, Span span) {
        const LeadingNumber number = leading_number(code_.signs(text.substr(0, 60), span));
        if (number.length > 0 && std::isfinite(number.value)) return number.value;
        file_.diagnostics.error(
            span, fmt::format("expected a number, found '{}'", comment_text(text.substr(0, 40))));
        return 1;
    }

    void ignore(const std::string& symbols, Span span) {
        system().filter = "ignore";
        system().filter_span = span;
        for (const char c : symbols)
            if (!std::isspace(static_cast<unsigned char>(c)) && c != ',')
                system().filter_symbols += std::string{c, ' '};
    }

    void name_values() {
        for (const std::string& name : rules_.values()) {
            const auto known = values_.find(name);
            if (known == values_.end())
                file_.diagnostics.warning(system().axiom_span,
                                          fmt::format("the text gives no value for '{}': it is 1", name));
            const double value = known == values_.end() ? 1 : known->second;
            system().blocks[LSystemMoment::start].push_back(
                {.name = name, .target = name, .value = shortest(value)});
        }
    }

    /// Numbers of parameters with which each symbol appears.
    std::map<std::string, std::set<std::size_t>> arities() {
        std::map<std::string, std::set<std::size_t>> all;
        const auto take = [&](const LSystemString& string) {
            for (const LSystemModule& module : string)
                all[module.symbol].insert(module.parameters.size());
        };
        take(system().axiom);
        for (const LSystemProduction& production : productions())
            take(production.successor);
        return all;
    }

    /// Houdini's rules are for a symbol, whatever its parameters: those that are missing are 0.
    void fit_arities() {
        const std::map<std::string, std::set<std::size_t>> all = arities();
        std::vector<LSystemProduction> fitted;
        for (const LSystemProduction& production : productions()) {
            if (production.predecessor.size() != 1) continue;
            const auto known = all.find(production.predecessor[0].symbol);
            if (known == all.end()) {
                fitted.push_back(production);
                continue;
            }
            if (known->second.size() > most_arities) {
                file_.diagnostics.error(production.span,
                                        fmt::format("'{}' has more than {} numbers of parameters",
                                                    production.predecessor[0].symbol, most_arities));
                break;
            }
            for (const std::size_t arity : known->second) {
                LSystemProduction& own = fitted.emplace_back(production);
                int names = 0;
                fit(own.predecessor[0], arity, own, names);
                for (LSystemString* const context : {&own.left, &own.right})
                    for (LSystemModule& module : *context) {
                        const auto others = all.find(module.symbol);
                        if (others != all.end() && others->second.size() == 1)
                            fit(module, *others->second.begin(), own, names);
                    }
            }
        }
        productions() = std::move(fitted);
    }

    /// `count`: of the names that were made for parameters that the rule has no name for.
    static void fit(LSystemModule& module, std::size_t arity, LSystemProduction& production, int& count) {
        std::vector<std::string>& names = module.parameters;
        for (; names.size() > arity; names.pop_back())
            production.before.push_back({.name = names.back(), .target = names.back(), .value = "0"});
        while (names.size() < arity)
            names.push_back(fmt::format("rest_{}", ++count));
        module.has_parentheses = arity > 0;
    }

    /// The first rule without a probability, behind rules for the same that have some, has their remainder.
    void rest_of_chances() {
        std::map<std::string, std::string> sums;
        for (LSystemProduction& production : productions()) {
            std::string& sum = sums[key_of(production)];
            if (!production.probability.empty())
                sum += (sum.empty() ? "" : " + ") + production.probability;
            else if (!sum.empty())
                production.probability = fmt::format("max(0, 1 - ({}))", std::exchange(sum, ""));
        }
    }

    /// Rules compete if they ask for the same.
    static std::string key_of(const LSystemProduction& production) {
        std::string key = production.condition;
        for (const LSystemString* const string :
             {&production.left, &production.predecessor, &production.right}) {
            key += "|";
            for (const LSystemModule& module : *string)
                key += fmt::format("{}{} ", module.symbol, module.parameters.size());
        }
        return key;
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    CodeReader code_;
    HoudiniRules rules_;
    HoudiniSystem houdini_;
    LSystemComments comments_;
    std::map<std::string, double> values_;
};

} // namespace

std::optional<HoudiniSystem> read_houdini(const ForeignFile& file, const ForeignModel& model) {
    return HoudiniReader(file, model).read();
}

} // namespace graftal
