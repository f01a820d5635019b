#include "compiler/import/cpfg/names.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <utility>

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/tools/roots.hpp>
#include <fmt/format.h>

#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"

namespace graftal {

CpfgNames::CpfgNames(const ForeignFile& file, const CpfgSource& source, const CpfgView& view,
                     const CpfgDialect* dialect)
    : file_(file), source_(source), view_(view), dialect_(dialect) {
    find_lets();
    find_renamed();
}

/// Finds which of `step` and `age` the blocks of the model assign.
void CpfgNames::find_renamed() {
    for (const CpfgStatement& statement : source_.statements) {
        const std::string small = in_small_letters(trimmed(statement.text).substr(0, 12));
        if (!small.starts_with("start") && !small.starts_with("end") && !small.starts_with("define"))
            continue;
        for (const char* const name : {"step", "age"})
            for (std::size_t at = statement.text.find(name); at != std::string::npos;
                 at = statement.text.find(name, at + 1)) {
                const std::size_t end = at + std::string_view(name).size();
                const bool whole = (at == 0 || !is_cpfg_name(statement.text[at - 1])) &&
                                   (end == statement.text.size() || !is_cpfg_name(statement.text[end]));
                const std::string_view rest = trimmed(std::string_view(statement.text).substr(end));
                if (whole && (rest.starts_with('[') || (rest.starts_with('=') && !rest.starts_with("=="))))
                    renamed_.insert(name);
            }
    }
}

std::string CpfgNames::own_name(std::string_view name) const {
    return std::string(name) + (renamed_.contains(std::string(name)) ? "_" : "");
}

std::string CpfgNames::with_own_names(std::string text) const {
    if (renamed_.empty()) return text;
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::string_view name = cpfg_name_at(text, i);
        out += name.empty() ? std::string(1, text[i]) : own_name(name);
        i += std::max<std::size_t>(name.size(), 1);
    }
    return out;
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
                const std::string name(cpfg_name_at(body, i));
                constexpr std::string_view known[] = {"sin", "cos", "tan", "sqrt", "exp", "log"};
                number = lets_.contains(name) || std::ranges::find(known, name) != std::end(known);
                i += name.size();
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
    return with_own_names(out.value_or(""));
}

std::string CpfgNames::expression(std::string_view text, Span span) {
    if (dialect_) return std::string(text);
    const CpfgCalls calls = [&](std::string_view name, std::span<const std::string_view> arguments,
                                std::span<const std::string> written) {
        return call(name, arguments, written, span);
    };
    const std::function<void(const std::string&)> complain = [&](const std::string& message) {
        error(span, message);
    };
    return translated_cpfg_expression(expanded(text, span, false), calls, complain);
}

std::optional<std::string> CpfgNames::call(std::string_view name, std::span<const std::string_view> arguments,
                                           std::span<const std::string> written, Span span) {
    if (name == "func" && arguments.size() == 2) {
        const CpfgFunction* const function = function_named(arguments[0], span);
        if (!function) return "0";
        return fmt::format("{}({})", table(function->name + "_of", function->values), written[1]);
    }
    if ((name == "curveX" || name == "curveY" || name == "curveZ") && arguments.size() == 2) {
        const CpfgViewCurve* const curve = curve_named(arguments[0], span);
        if (!curve) return "0";
        const auto axis = static_cast<std::size_t>(name.back() - 'X');
        return fmt::format(
            "{}({})", table(fmt::format("{}_{}_of", curve->name, "xyz"[axis]), curve->curve.points[axis]),
            written[1]);
    }
    if (name == "curveGAL" && arguments.size() == 1) {
        const CpfgViewCurve* const curve = curve_named(arguments[0], span);
        return shortest(curve ? curve->curve.length : 0);
    }
    if (name == "bran" && arguments.size() == 2) return beta(arguments, span);
    return std::nullopt;
}

/// The name of a table that has these values from now on.
std::string CpfgNames::table(std::string name, std::vector<double> values) {
    if (std::ranges::find(tables_, name, &CpfgFunction::name) == tables_.end())
        tables_.push_back({name, std::move(values)});
    return name;
}

/// The place that the text of a number says, from 0 on, below `count`.
std::optional<std::size_t> CpfgNames::place_named(std::string_view id, std::size_t count, Span span) {
    const std::string number(trimmed(expanded(id, span, true)));
    if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
    const auto place = static_cast<std::size_t>(std::strtoul(number.substr(0, 9).c_str(), nullptr, 10));
    if (place == 0 || place > count) return std::nullopt;
    return place - 1;
}

const CpfgFunction* CpfgNames::function_named(std::string_view id, Span span) {
    if (view_.functions_have_names) {
        const auto named = std::ranges::find(view_.functions, plain_name(trimmed(id)), &CpfgFunction::name);
        if (named != view_.functions.end()) return &*named;
    }
    if (const auto place = place_named(id, view_.functions.size(), span)) return &view_.functions[*place];
    error(span, fmt::format("there is no function {} among those that the view file names",
                            comment_text(expanded(id, span, true))));
    return nullptr;
}

const CpfgViewCurve* CpfgNames::curve_named(std::string_view id, Span span) {
    const auto place = place_named(id, view_.curves.size(), span);
    if (place && view_.curves[*place].curve.length > 0) return &view_.curves[*place];
    error(span, fmt::format("curve {} of the view file is no spline that has a translation",
                            comment_text(expanded(id, span, true))));
    return nullptr;
}

namespace {

/// Where a share of the distribution lies below. Boost's ibeta_inv() takes Newton's steps, and throws at the
/// median of beta(5, 5).
double beta_quantile(double a, double b, double share) {
    if (share <= 0 || share >= 1) return share;
    const auto excess = [&](double x) { return boost::math::ibeta(a, b, x) - share; };
    const auto [below, above] =
        boost::math::tools::bisect(excess, 0.0, 1.0, boost::math::tools::eps_tolerance<double>(40));
    return 0.5 * (below + above);
}

} // namespace

/// A beta variate, by a table of the distribution's inverse.
std::string CpfgNames::beta(std::span<const std::string_view> arguments, Span span) {
    std::vector<double> shape;
    for (const std::string_view argument : arguments) {
        const std::string number(trimmed(expanded(argument, span, true)));
        const LeadingNumber read = leading_number(number);
        shape.push_back(read.value);
        if (read.length != number.size() || !(shape.back() > 0 && shape.back() < 1000)) {
            error(span, "'bran' has a translation only with two numbers above 0");
            return "0";
        }
    }
    constexpr int pieces = 64;
    std::vector<double> values;
    for (int i = 0; i <= pieces; ++i)
        values.push_back(beta_quantile(shape[0], shape[1], static_cast<double>(i) / pieces));
    return fmt::format("{}(random(0, 1))",
                       table(plain_name(fmt::format("beta_{}_{}", shape[0], shape[1])), std::move(values)));
}

} // namespace graftal
