#include "compiler/lower/inner_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "compiler/lower/lower_settings.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::size_t usual_members = 16;
/// Arguments are computed.
constexpr double slack = 1e-9;

std::optional<std::size_t> members_of(const SceneField& field, const Environment& lets,
                                      Diagnostics& diagnostics) {
    const std::optional<double> members = evaluate(field.values[1], lets, diagnostics);
    if (!members) return std::nullopt;
    if (*members >= 2 && *members <= max_family && *members == std::floor(*members))
        return static_cast<std::size_t>(*members);
    diagnostics.error(
        field.values[1].span,
        fmt::format("'members' must be a whole number from 2 to {}, not {}", max_family, shortest(*members)));
    return std::nullopt;
}

/// Fills in numbers of members that are left out: as large as the whole family allows.
void fill_in_members(std::vector<InnerParameter>& parameters) {
    std::size_t given = 1, open = 0;
    for (const InnerParameter& parameter : parameters) {
        given = std::min(given * std::max<std::size_t>(parameter.members, 1), max_family + 1);
        open += parameter.members == 0;
    }
    const auto all = [&](std::size_t members) {
        double size = static_cast<double>(given);
        for (std::size_t i = 0; i < open; ++i)
            size *= static_cast<double>(members);
        return size;
    };
    std::size_t members = usual_members;
    while (members > 2 && all(members) > max_family)
        --members;
    for (InnerParameter& parameter : parameters)
        if (parameter.members == 0) parameter.members = members;
}

void check_size(std::span<const InnerParameter> parameters, Diagnostics& diagnostics) {
    if (parameters.empty() || family_size(parameters) <= max_family) return;
    diagnostics
        .error(parameters.back().span,
               fmt::format("the inner parameters make a family of more than {} models", max_family))
        .with_hint("smaller 'members' make it smaller: inner a = 0.5 members 8");
}

} // namespace

std::vector<InnerParameter> inner_parameters(const std::vector<SceneStatement>& statements,
                                             const Environment& lets, Diagnostics& diagnostics) {
    std::vector<InnerParameter> parameters;
    for (const SceneStatement& statement : statements) {
        if (statement.kind != SceneStatement::Kind::inner) continue;
        for (const SceneField& field : statement.fields) {
            const auto value = lets.find(field.keyword);
            if (value == lets.end()) continue; // reported: its name is no name
            const double usual = std::isnan(value->second) ? 0 : value->second; // 0 after an error
            InnerParameter parameter{field.keyword, usual, 0, field.span};
            if (field.values.size() > 1)
                parameter.members = members_of(field, lets, diagnostics).value_or(usual_members);
            parameters.push_back(std::move(parameter));
        }
    }
    fill_in_members(parameters);
    check_size(parameters, diagnostics);
    return parameters;
}

std::vector<InnerParameter> inner_parameters_of(FileId file, Lowering& lowering) {
    Diagnostics quiet;
    // Any file but the root's: `--set` does not speak to it.
    Lowering aside{.sources = lowering.sources,
                   .diagnostics = quiet,
                   .options = lowering.options,
                   .help = lowering.help,
                   .meter = lowering.meter,
                   .languages = lowering.languages,
                   .parsed = lowering.parsed,
                   .loading = std::vector<LoadingFile>(2)};
    const Language* const language = language_of(file, lowering.sources, lowering.languages);
    if (!language) return {};
    const InnerStatements statements =
        lowering.parsed.tree(*language, file, lowering.sources, lowering.languages, quiet).inner_statements();
    const Environment of_file = evaluate_lets(statements.file, {}, aside);
    const Environment of_block = evaluate_lets(statements.block, of_file, aside);
    std::vector<SceneStatement> all = statements.file;
    all.insert(all.end(), statements.block.begin(), statements.block.end());
    return inner_parameters(all, of_block, quiet);
}

std::size_t family_size(std::span<const InnerParameter> parameters) {
    std::size_t size = 1;
    for (const InnerParameter& parameter : parameters)
        size = std::min(size * parameter.members, max_family + 1);
    return size;
}

std::vector<double> nearest_member(std::span<const InnerParameter> parameters,
                                   std::span<const double> arguments) {
    std::vector<double> values;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const InnerParameter& parameter = parameters[i];
        values.push_back(parameter.value);
        if (i >= arguments.size()) continue;
        const double argument = std::clamp(arguments[i], 0.0, 1.0);
        const auto last = static_cast<double>(parameter.members - 1);
        const double member = std::round(argument * last) / last;
        if (std::abs(member - argument) < std::abs(parameter.value - argument)) values.back() = member;
    }
    return values;
}

Environment named_values(std::span<const InnerParameter> parameters, const std::vector<double>& values) {
    Environment named;
    for (std::size_t i = 0; i < std::min(parameters.size(), values.size()); ++i)
        named[parameters[i].name] = values[i];
    return named;
}

std::string inner_argument_error(std::string_view model, std::span<const InnerParameter> parameters,
                                 std::span<const double> arguments) {
    for (std::size_t i = 0; i < std::min(parameters.size(), arguments.size()); ++i)
        if (!(arguments[i] >= -slack && arguments[i] <= 1 + slack))
            return fmt::format("'{}' of '{}' lies between 0 and 1, not at {}", parameters[i].name, model,
                               shortest(arguments[i]));
    return {};
}

} // namespace graftal
