#include "compiler/lsys/walk/plant.h"

#include <algorithm>
#include <utility>

#include "compiler/lsys/derive/word.h"
#include "compiler/lsys/turtle/flat_model.h"
#include "compiler/lsys/walk/plant_tally.h"
#include "compiler/support/stretch.h"

namespace graftal {

bool PlantBuilder::begins(const Module& module, const Turtle& turtle) {
    if (!has_room()) return false;
    age_ = module.birth == ModuleTable::no_birth ? -1 : plant_.steps - module.birth;
    const TurtleCommand command = grammar_.commands[module.symbol];
    if (!(module.is_interpreted ? is_plant_part(command) : command == TurtleCommand::none)) return true;
    const Axis before = axis_;
    add(row(module.symbol, module.parameters, turtle));
    if (!module.is_interpreted) return true;
    whole_ = axis_.last;
    whole_depth_ = axes_.size();
    axis_ = before; // parts are borne by what bears the whole
    return true;
}

void PlantBuilder::ends(const Turtle& turtle) {
    if (whole_ == PlantModule::none) return;
    PlantModule& whole = plant_.modules[whole_];
    end(whole, turtle);
    if (axes_.size() == whole_depth_ && axis_.last != PlantModule::none && axis_.last > whole_)
        whole.last_part = axis_.last;
    if (axes_.size() == whole_depth_) axis_ = {whole_, false, whole.order, whole.rank + 1};
    whole_ = PlantModule::none;
}

void PlantBuilder::runs(SymbolId symbol, std::span<const double> parameters, const Turtle& turtle) {
    const TurtleCommand command = grammar_.commands[symbol];
    if (command == TurtleCommand::open_branch) opens_branch();
    if (command == TurtleCommand::close_branch) closes_branch();
    next_ = row(symbol, parameters, turtle);
    first_ = plant_.modules.size();
    if (command == TurtleCommand::open_polygon) polygons_.push_back(next_);
}

bool PlantBuilder::has_run(const Turtle& turtle) {
    for (std::size_t i = first_; i < plant_.modules.size(); ++i)
        end(plant_.modules[i], turtle);
    // A cut takes polygons away that began in its branch.
    if (turtle.passing_over() && !polygons_.empty())
        polygons_.resize(std::min<std::size_t>(polygons_.size(), turtle.state().open_polygons));
    return has_room();
}

bool PlantBuilder::has_room() {
    return plant_.modules.size() <= most_rows_ ||
           refuse_length(grammar_, most_rows_, static_cast<std::uint32_t>(plant_.steps), diagnostics_);
}

/// A row for the body; of a polygon it begins where the polygon does.
void PlantBuilder::draws(const DrawnBody& body) {
    PlantModule drawn = next_;
    if (body.organ == Organ::polygon && !polygons_.empty()) {
        drawn = std::move(polygons_.back());
        polygons_.pop_back();
    }
    const double size = frame_.size;
    drawn.organ = body.organ;
    if (body.start) drawn.start = frame_.place(*body.start);
    if (!body.material.empty()) drawn.material = number_of_material(plant_.materials, body.material);
    drawn.length = size * body.length;
    drawn.width = size * body.width;
    drawn.base_width = size * body.base_width;
    drawn.area = size * size * body.area;
    drawn.volume = size * size * size * body.volume;
    drawn.is_measured = body.is_measured;
    if (whole_ != PlantModule::none) {
        drawn.part_of = whole_;
        PlantModule& whole = plant_.modules[whole_];
        whole.length += drawn.length;
        whole.area += drawn.area;
        whole.volume += drawn.volume;
        whole.is_measured = whole.is_measured && drawn.is_measured;
    }
    add(std::move(drawn));
    add_blade(body);
}

/// The surface of the last row, if that is made of triangles.
void PlantBuilder::add_blade(const DrawnBody& body) {
    PlantBlade blade{static_cast<std::uint32_t>(plant_.modules.size() - 1), 0, {}, 0};
    if (body.organ == Organ::polygon) {
        blade.shape = static_cast<std::uint32_t>(plant_.shapes.size());
        std::vector<PlantTriangle>& triangles = plant_.shapes.emplace_back();
        for (const auto& [a, b, c] : body.triangles)
            triangles.push_back({frame_.place(a), frame_.place(b), frame_.place(c)});
    } else if (body.organ == Organ::model && body.is_measured && body.graph) {
        blade.shape = shape_of(*body.graph, body.model);
        blade.world_from_shape = {frame_.world_from_part.linear * (frame_.size * body.part_from_model.linear),
                                  frame_.place(body.part_from_model.translation)};
        blade.half_thickness =
            half_thicknesses_[blade.shape] * largest_stretch(blade.world_from_shape.linear);
    } else {
        return;
    }
    plant_.blades.push_back(blade);
}

std::uint32_t PlantBuilder::shape_of(const Graph& graph, ObjectId model) {
    const auto [known, fresh] = shapes_.try_emplace(model, static_cast<std::uint32_t>(plant_.shapes.size()));
    if (fresh) {
        FlatSide side = flat_side(graph, model);
        plant_.shapes.push_back(std::move(side.triangles));
        half_thicknesses_.resize(plant_.shapes.size());
        half_thicknesses_.back() = side.half_thickness;
    }
    return known->second;
}

/// A branch that begins where another has just begun leaves the same module.
void PlantBuilder::opens_branch() {
    axes_.push_back(axis_);
    const bool leaves = axis_.last != PlantModule::none && !axis_.begins;
    axis_ = {axis_.last, true, axis_.order + (leaves ? 1 : 0), 0};
}

void PlantBuilder::closes_branch() {
    if (axes_.empty()) return;
    axis_ = axes_.back();
    axes_.pop_back();
}

/// A row for a module where the turtle is.
PlantModule PlantBuilder::row(SymbolId symbol, std::span<const double> parameters, const Turtle& turtle) {
    const Affine world_from_turtle = frame_.of_child(turtle.start_from_turtle(), 1).world_from_part;
    PlantModule row;
    row.name = symbol; // add() numbers names
    row.parameters.assign(parameters.begin(), parameters.end());
    row.start = world_from_turtle.translation;
    row.heading = world_from_turtle.linear[1];
    row.left = -world_from_turtle.linear[0];
    row.up = world_from_turtle.linear[2];
    row.age = age_;
    end(row, turtle);
    return row;
}

/// Puts the row on the axis.
void PlantBuilder::add(PlantModule row) {
    row.name = name_of_symbol(row.name);
    row.parent = axis_.last;
    row.branches = axis_.begins && axis_.last != PlantModule::none;
    row.order = axis_.order;
    row.rank = axis_.next_rank++;
    axis_.last = static_cast<std::uint32_t>(plant_.modules.size());
    axis_.begins = false;
    plant_.modules.push_back(std::move(row));
}

void PlantBuilder::end(PlantModule& row, const Turtle& turtle) const {
    row.end = frame_.place(turtle.start_from_turtle().translation);
    if (row.organ == Organ::none) row.width = frame_.size * turtle.diameter();
}

std::uint16_t PlantBuilder::name_of_symbol(SymbolId symbol) {
    const auto [known, fresh] = names_.try_emplace(symbol, static_cast<std::uint16_t>(plant_.names.size()));
    if (fresh) plant_.names.push_back(grammar_.symbols[symbol]);
    return known->second;
}

} // namespace graftal
