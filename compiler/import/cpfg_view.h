#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"

namespace graftal {

/// A function of [0, 1] by its values at even distances, straight between them.
struct CpfgFunction {
    std::string name;
    std::vector<double> values;
};

/// A surface that `~` and a letter place.
struct CpfgSurface {
    std::string file;
    double scale = 1;
};

/// What the view file of a model says of the turtle.
struct CpfgView {
    double angle_deg = 45;
    int colour = 0;
    bool has_colour = false;
    int colour_increment = 1;
    std::optional<double> width; ///< in the units of the model
    double width_increment = 0;
    bool width_in_pixels = true;
    std::vector<CpfgFunction> functions;  ///< number 1 is the first
    std::map<char, CpfgSurface> surfaces; ///< by their letters
};

/// Reads the view file that goes with a model, which has its name with another ending, and the files of
/// functions that it names. Values without such a file are those of cpfg.
CpfgView read_cpfg_view(const ForeignFile& file);

} // namespace graftal
