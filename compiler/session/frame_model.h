#pragma once

#include <optional>

#include "compiler/scene/scene.h"
#include "compiler/session/stage_options.h"
#include "compiler/session/values.h"

namespace graftal {

struct Sight {
    Box bounds;        ///< a stand-in where there is nothing but planes
    Outliner outliner; ///< of it, while the model lives; nothing: the bounds are all that is known
};

/// What is to be seen of a model: an unending one by its levels, if it has a number of them (`steps`) that
/// can be looked at part by part, else its limit set.
Sight sight_of(const AnalysedModel& model, std::optional<unsigned> steps);

/// The view of what is seen so, without zoom and shared framing.
View frame_graph(const Graph& graph, const Sight& sight, const ViewOptions& options,
                 CloudPictures* clouds = nullptr);

/// The view of a model as it will be drawn, without zoom and shared framing.
View frame_model(const AnalysedModel& model, std::optional<unsigned> steps, const ViewOptions& options);

} // namespace graftal
