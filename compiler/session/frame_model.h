#pragma once

#include <optional>

#include "compiler/scene/scene.h"
#include "compiler/session/stage_options.h"
#include "compiler/session/values.h"

namespace graftal {

struct Sight {
    Box bounds;        ///< a stand-in where there is nothing but planes
    Outliner outliner; ///< outlines it while the model lives; nothing: only the bounds are known
};

/// The visible part of a model: the levels of an unending one, if they are limited (`steps`) and can be
/// looked at part by part, else the limit set.
Sight sight_of(const AnalysedModel& model, std::optional<unsigned> steps);

/// The view of what is seen so, without zoom and shared framing.
View frame_graph(const Graph& graph, const Sight& sight, const ViewOptions& options,
                 CloudPictures* clouds = nullptr);

/// The view of a model as it will be drawn, without zoom and shared framing.
View frame_model(const AnalysedModel& model, std::optional<unsigned> steps, const ViewOptions& options);

} // namespace graftal
