#pragma once

#include <array>
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

/// A direction that segments bend towards, or twist towards.
struct CpfgTropism {
    std::string direction; ///< "x, y, z"
    double elasticity = 0;
    double angle_deg = 0; ///< angle between headings and the direction that they tend to
    bool twists = false;
};

/// A curve in space by points at even distances along it.
struct CpfgCurve {
    std::array<std::vector<double>, 3> points; ///< x, y, z
    double length = 0;
};

/// A curve that `curve:` names.
struct CpfgViewCurve {
    std::string name;
    CpfgCurve curve;
};

/// The turtle's settings in the view file of a model.
struct CpfgView {
    double angle_deg = 45;
    int colour = 0;
    bool has_colour = false;
    int colour_increment = 1;
    std::optional<double> width; ///< in the units of the model
    double width_increment = 0;
    bool width_in_pixels = true;
    std::vector<CpfgFunction> functions;       ///< number 1 is the first
    bool functions_have_names = false;         ///< functions of a gallery do
    std::map<char, CpfgSurface> surfaces;      ///< by their letters
    std::vector<CpfgViewCurve> curves;         ///< number 1 is the first
    std::string tropism_direction = "0, 1, 0"; ///< goal of `_`
    double elasticity = 0, elasticity_increment = 0;
    std::vector<CpfgTropism> tropisms; ///< by their numbers
    bool draws_past_cuts = true;
};

/// Reads the view file of a model, and the files of functions and curves that it names. Values without such a
/// file (an empty name) are those of cpfg.
CpfgView read_cpfg_view(const ForeignFile& file, const std::string& view_name);

} // namespace graftal
