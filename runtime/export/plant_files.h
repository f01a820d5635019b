#pragma once

#include <string>
#include <string_view>

#include "compiler/lower/plant.h"

namespace graftal {

/// A format for the structure of a plant, one row a module: its name, parameters, parent, order, rank, place,
/// length and width.
struct PlantFormat {
    std::string_view extension; ///< with its point
    std::string_view summary;
    std::string (*text)(const Plant& plant);
};

/// The format that the ending of a file's name asks for; null if there is none.
const PlantFormat* find_plant_format(std::string_view path);

/// ".csv, .json or .mtg"
std::string plant_endings();

} // namespace graftal
