#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "compiler/lower/plant.h"
#include "compiler/lower/plant_sums.h"
#include "runtime/plants/plant_light.h"
#include "runtime/plants/plant_measures.h"
#include "runtime/render/render.h"

namespace graftal {

/// The plant that an L-system's model shows; null after an error: `else_error` where it is no L-system.
std::shared_ptr<const Plant> plant_of_model(Session& session, StageOptions stages,
                                            std::string_view else_error, Compilation& compilation);

/// A plant, or the totals of one that has too many modules for rows, unless that `needs_rows`; both null
/// after an error.
struct PlantOrTotals {
    std::shared_ptr<const Plant> plant;
    std::shared_ptr<const PlantTotals> totals;
};
PlantOrTotals plant_or_totals_of_model(Session& session, StageOptions stages, bool needs_rows,
                                       Compilation& compilation);

/// Measures of that plant within the work of the stages; nothing after an error, or with a failed status
/// where it was cancelled.
std::optional<PlantMeasures> measures_of_model(const Session& session, const StageOptions& stages,
                                               const Plant& plant, std::optional<double> ground_area,
                                               Compilation& compilation);

/// The light on that plant, in the light that the model names. Nothing after an error, or with a failed
/// status where it was cancelled. Few samples for the work that is allowed are a warning.
std::optional<PlantLight> light_of_model(PictureSession& session, const RenderOptions& options,
                                         const Plant& plant, const PlantLightOptions& light,
                                         Compilation& compilation);

} // namespace graftal
