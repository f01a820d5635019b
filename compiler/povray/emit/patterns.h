#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compiler/graph/material.h"
#include "compiler/scene/povray_units.h"

namespace graftal {

/// Solid patterns as functions of POV-Ray, which say what trace/shade/patterns.glsl does. Octaves finer than
/// a pixel do not fade out there.
class PovrayPatterns {
  public:
    /// `prefix` begins every name.
    PovrayPatterns(std::string prefix, const PovrayUnits& units)
        : prefix_(std::move(prefix)), units_(units) {}

    /// A function of a place of the scene, between 0 and 1: `Name(...)`. `size`: pattern_size().
    std::string value(const SolidPattern& pattern, double size);
    /// `normal { ... }` of the relief, or "" where there is none.
    std::string relief(const SolidPattern& pattern, double size);

    /// `#declare` of all functions that these name, in an order in which each knows those that it calls.
    const std::string& declarations() const { return declarations_; }

  private:
    std::string layer(const PatternLayer& layer, double wavelength);
    /// Name of a function of x, y and z.
    std::string declared(const std::string& body);
    std::string at_place(const std::string& name) const;

    std::string prefix_;
    const PovrayUnits units_;
    std::map<std::string, std::string> names_; ///< by body
    std::string declarations_;
};

} // namespace graftal
