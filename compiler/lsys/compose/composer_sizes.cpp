#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "compiler/lsys/compose/composer.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

// The part of the composer that looks up and draws modules that differ in their size only.

namespace graftal {

std::vector<double> LsysComposer::parameters_of(ModuleId module) const {
    const std::span<const double> parameters = rewriter_.modules().parameters(module);
    return {parameters.begin(), parameters.end()};
}

/// A module whose sizes are in units, with its sizes as long as they are here.
ModuleId LsysComposer::in_units(ModuleId module, double unit) {
    if (unit == 1) return module;
    ModuleTable& modules = rewriter_.modules();
    const SymbolId symbol = modules.symbol(module);
    std::vector<double> parameters = parameters_of(module);
    const std::span<const ParameterRole> roles = sizes_->roles(symbol, parameters.size());
    for (std::size_t i = 0; i < roles.size(); ++i)
        if (roles[i] != ParameterRole::number) parameters[i] *= unit;
    return modules.intern(symbol, parameters, modules.birth(module));
}

/// The module, and the state that it finds, in a frame in which its first length is 1; without a length, its
/// first width; without any, the unit. False after an error.
bool LsysComposer::resize(Lookup& found, const Task& task, bool absolute) {
    ModuleTable& modules = rewriter_.modules();
    const SymbolId symbol = modules.symbol(found.module);
    found.state = state_of(task.turtle, found.placing.snap);
    std::vector<double> parameters = parameters_of(found.module);
    const std::span<const ParameterRole> roles = sizes_->roles(symbol, parameters.size());
    const double unit = found.state.unit;
    constexpr std::size_t nothing = SIZE_MAX;
    std::size_t leading = nothing;
    for (const ParameterRole role : {ParameterRole::length, ParameterRole::width})
        for (std::size_t i = 0; i < roles.size() && leading == nothing; ++i)
            if (roles[i] == role && parameters[i] != 0) leading = i;
    Placing& placing = found.placing;
    placing.scale = leading == nothing ? unit : std::abs(parameters[leading]) * (absolute ? unit : 1);
    if (!(placing.scale >= least_size && placing.scale <= largest_size)) {
        placing.scale = unit; // it is drawn as it is, or the turtle says why not
        leading = nothing;
    }
    placing.absolute = absolute || leading == nothing;
    const double factor = 1 / placing.scale;
    for (std::size_t i = 0; i < roles.size(); ++i) {
        if (roles[i] == ParameterRole::number) continue;
        parameters[i] *= (absolute ? unit : 1) * factor;
        if (i == leading)
            parameters[i] = std::copysign(1.0, parameters[i]);
        else if (roles[i] == ParameterRole::width)
            parameters[i] = stepped(parameters[i], placing.size_error);
    }
    if (!roles.empty()) found.module = modules.intern(symbol, parameters, modules.birth(found.module));
    const double width = found.state.width;
    found.state = scaled(found.state, factor);
    if (context_.relative_width)
        found.state.width = width;
    else
        found.state.width = stepped(found.state.width, placing.width_error);
    found.state.control_width = sizes_known_.representative(found.state.control_width);
    double collar_error = 0; // shapes a collar, and displaces nothing
    found.state.limb_radius = stepped(found.state.limb_radius, collar_error);
    if (found.state.in_cylinder) found.state.control_point = representative(found.state.control_point);
    found.state.unit = steps_unit_ ? stepped(found.state.unit, placing.unit_error)
                                   : sizes_known_.representative(found.state.unit);
    if (found.state.unit <= largest_size && found.state.width <= largest_size) return true;
    context_.diagnostics
        .error(task.span,
               fmt::format("a size here is less than {} of the model's first size", shortest(least_size)))
        .with_hint("use fewer steps to keep the model within the range of numbers");
    return false;
}

/// The size that stands for one: of the steps in which its logarithm is counted, the nearest.
double LsysComposer::stepped(double size, double& error) {
    if (size_step_ == 0 || !(size > 0)) return sizes_known_.representative(size);
    const double log_size = std::log(size);
    const double nearest = size_step_ * std::round(log_size / size_step_);
    error = std::max(error, std::abs(log_size - nearest));
    return std::exp(nearest);
}

/// The parameters of a module as the model writes them.
std::vector<double> LsysComposer::written_parameters(const Task& task, ModuleId module, bool absolute) const {
    std::vector<double> parameters = parameters_of(module);
    if (!sizes_) return parameters;
    const SymbolId symbol = rewriter_.modules().symbol(module);
    const std::span<const ParameterRole> roles = sizes_->roles(symbol, parameters.size());
    const double size = (absolute ? task.turtle.unit() : 1) * task.frame.size;
    for (std::size_t i = 0; i < roles.size(); ++i)
        if (roles[i] != ParameterRole::number) parameters[i] = unrounded(parameters[i] * size);
    return parameters;
}

/// Tells the witness of a module of the word that others are drawn in place of.
bool LsysComposer::begins_interpretation(const Task& task, ModuleId module, bool absolute,
                                         std::uint32_t birth) {
    if (!witness_ || task.interprets) return true;
    const std::vector<double> parameters = written_parameters(task, module, absolute);
    return witness_->begins({rewriter_.modules().symbol(module), parameters, birth, true}, task.turtle);
}

bool LsysComposer::draw(Task& task, ModuleId module, bool absolute, std::uint32_t birth) {
    if (!witness_) return carry_out(task, module, absolute);
    if (task.turtle.passing_over()) {
        if (!carry_out(task, module, absolute)) return false;
        if (!task.turtle.passing_over()) witness_->closes_branch();
        return true;
    }
    const SymbolId symbol = rewriter_.modules().symbol(module);
    const std::vector<double> parameters = written_parameters(task, module, absolute);
    if (!task.interprets && !witness_->begins({symbol, parameters, birth}, task.turtle)) return false;
    witness_->runs(symbol, parameters, task.turtle);
    if (!carry_out(task, module, absolute)) return false;
    if (!witness_->has_run(task.turtle)) return false;
    if (!task.interprets) witness_->ends(task.turtle);
    return true;
}

bool LsysComposer::carry_out(Task& task, ModuleId module, bool absolute) {
    const SymbolId symbol = rewriter_.modules().symbol(module);
    const TurtleCommand command = rewriter_.grammar().commands[symbol];
    const double unit = task.turtle.unit();
    if (absolute) module = in_units(module, unit);
    std::span<const double> parameters = rewriter_.modules().parameters(module);
    std::vector<double> resized;
    std::optional<PlacedModel> model;
    if (command == TurtleCommand::model && !task.turtle.passing_over()) {
        model = models_(symbol, parameters, task.span);
        if (!model) return false;
        if (sizes_ && !sizes_->gives_scale(symbol, parameters.size())) {
            model->scale *= unit;
            absolute = true;
        }
    }
    if (sizes_ && size_role(rewriter_.grammar(), symbol) && !parameters.empty() &&
        sizes_->roles(symbol, parameters.size())[0] == ParameterRole::number) {
        resized.assign(1, unit * parameters[0]);
        parameters = resized;
        absolute = true;
    }
    return task.turtle.run(command, parameters, model, task.span, absolute);
}

} // namespace graftal
