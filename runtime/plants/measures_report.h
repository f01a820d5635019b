#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/plants/plant_light.h"
#include "runtime/plants/plant_measures.h"

namespace graftal {

/// The text of `graftal stats --plant --json`: one object, its keys in a fixed order. `light`, if it is not
/// null, is the light that the plant takes.
std::string measures_json(std::string_view model, const PlantMeasures& measures, const PlantLight* light);

/// The text of it for people: a line a key, and a table for each list.
std::string measures_text(std::string_view model, const PlantMeasures& measures, const PlantLight* light);

/// Both texts for a plant that has too many modules for rows, with the keys that are known of it.
/// `ground_area`: that was given.
std::string totals_json(std::string_view model, const PlantTotals& totals, std::optional<double> ground_area);
std::string totals_text(std::string_view model, const PlantTotals& totals, std::optional<double> ground_area);

/// A key of measures_text(): of a line, or "orders angle" for a column of a table.
struct MeasuresKey {
    std::string_view name;
    std::string_view meaning;
};

/// The keys that measures_text() may print, in its order.
std::span<const MeasuresKey> measures_keys();

} // namespace graftal
