#pragma once

#include <span>
#include <string>
#include <vector>

#include "compiler/lower/lowering.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

/// `inner k = 0.5 members 16`: a number in [0, 1] that says which of its family a model is. Each map or
/// length follows it within a range of its own. Users of the model may give it.
struct InnerParameter {
    std::string name;
    double value = 0;        ///< if it is not given
    std::size_t members = 0; ///< values that it is rounded to where a family must be finite; at least 2
    Span span;
};

/// The members of all of a model's parameters together may not be more.
inline constexpr std::size_t max_family = 256;

/// The inner parameters among the statements, in the order of the text; `lets`: their values too, see
/// evaluate_lets(). Without `members` one has 16, or what others leave of max_family. Errors: numbers that
/// are not whole or too small, too large a family.
std::vector<InnerParameter> inner_parameters(const std::vector<SceneStatement>& statements,
                                             const Environment& lets, Diagnostics& diagnostics);

/// The parameters that a model file takes from its users: of the file, then of its main block. Errors of the
/// file are left to its lowering.
std::vector<InnerParameter> inner_parameters_of(FileId file, Lowering& lowering);

/// Number of models that the values of these parameters are rounded to.
std::size_t family_size(std::span<const InnerParameter> parameters);

/// The values of the member that stands for the model with these arguments: i/(N - 1), or the default where
/// that is nearer, or where there is no argument.
std::vector<double> nearest_member(std::span<const InnerParameter> parameters,
                                   std::span<const double> arguments);

/// The values of the parameters by name.
Environment named_values(std::span<const InnerParameter> parameters, const std::vector<double>& values);

/// The error of the first argument that lies outside of its parameter's range, [0, 1], by more than
/// rounding: "'k' of 'leaf' lies between 0 and 1, not at 2". An empty text if there is none.
std::string inner_argument_error(std::string_view model, std::span<const InnerParameter> parameters,
                                 std::span<const double> arguments);

} // namespace graftal
