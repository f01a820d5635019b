#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/derivation.h"
#include "compiler/lower/inner_parameters.h"

namespace graftal {

/// A model with inner parameters inside another: its members, each made when it is first asked for. So a
/// plant with a thousand leaves of different shapes has no more leaves than its family.
class ModelFamily {
  public:
    /// The root of the member with these values; nothing after an error. Called once for the same values.
    using Make = std::function<std::optional<ObjectId>(const std::vector<double>& values)>;

    ModelFamily(std::string name, std::vector<InnerParameter> parameters, Make make)
        : name_(std::move(name)), parameters_(std::move(parameters)), make_(std::move(make)) {}

    const std::string& name() const { return name_; }
    const std::vector<InnerParameter>& parameters() const { return parameters_; }

    /// The member nearest to these arguments, of which those beyond the parameters do not count. An argument
    /// outside of [0, 1] is an error at `place`.
    std::optional<ObjectId> nearest(std::span<const double> arguments, Span place, Diagnostics& diagnostics);
    /// The member with just these arguments, missing ones being the defaults; the same errors, and one for
    /// more than a thousand members.
    std::optional<ObjectId> exact(std::span<const double> arguments, Span place, Diagnostics& diagnostics);

    bool is_used() const { return !members_.empty(); }
    FamilyReport report() const;

  private:
    std::optional<ObjectId> member(const std::vector<double>& values);
    bool check(std::span<const double> arguments, Span place, Diagnostics& diagnostics) const;

    std::string name_;
    std::vector<InnerParameter> parameters_;
    Make make_;
    std::map<std::vector<double>, std::optional<ObjectId>> members_; ///< by their values
    bool failed_ = false; ///< errors were reported: other members would have them too
    double farthest_ = 0; ///< from an argument to the value in its place
};

} // namespace graftal
