#include "compiler/lower/model_family.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace graftal {

namespace {

constexpr std::size_t max_exact_members = 1000;

} // namespace

bool ModelFamily::check(std::span<const double> arguments, Span place, Diagnostics& diagnostics) const {
    const std::string problem = inner_argument_error(name_, parameters_, arguments);
    if (problem.empty()) return true;
    diagnostics.error(place, problem)
        .with_hint("inner parameters are shares of a range: lerp(lo, hi, k) in the model gives the range");
    return false;
}

std::optional<ObjectId> ModelFamily::nearest(std::span<const double> arguments, Span place,
                                             Diagnostics& diagnostics) {
    if (!check(arguments, place, diagnostics)) return std::nullopt;
    const std::vector<double> values = nearest_member(parameters_, arguments);
    for (std::size_t i = 0; i < std::min(values.size(), arguments.size()); ++i)
        farthest_ = std::max(farthest_, std::abs(std::clamp(arguments[i], 0.0, 1.0) - values[i]));
    return member(values);
}

std::optional<ObjectId> ModelFamily::exact(std::span<const double> arguments, Span place,
                                           Diagnostics& diagnostics) {
    if (!check(arguments, place, diagnostics)) return std::nullopt;
    std::vector<double> values;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
        values.push_back(i < arguments.size() ? std::clamp(arguments[i], 0.0, 1.0) : parameters_[i].value);
    if (members_.size() < max_exact_members || members_.contains(values)) return member(values);
    diagnostics.error(
        place, fmt::format("more than {} different arguments are given to '{}'", max_exact_members, name_));
    return std::nullopt;
}

std::optional<ObjectId> ModelFamily::member(const std::vector<double>& values) {
    if (const auto known = members_.find(values); known != members_.end()) return known->second;
    if (failed_) return std::nullopt;
    const std::optional<ObjectId> root = make_(values);
    failed_ = !root;
    return members_[values] = root;
}

FamilyReport ModelFamily::report() const {
    FamilyReport report;
    report.model = name_;
    for (const InnerParameter& parameter : parameters_)
        report.parameters.push_back(parameter.name);
    report.used = members_.size();
    report.possible = std::max(members_.size(), family_size(parameters_));
    report.error = farthest_;
    return report;
}

} // namespace graftal
