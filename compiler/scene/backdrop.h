#pragma once

#include <vector>

#include "compiler/scene/scene.h"

namespace graftal {

/// Colours that the model's leaves show, without shading: tints and base colours of a few hundred paths of
/// the unfolding, drawn at random but always the same. Requires a verified graph.
std::vector<Rgb> sample_colours(const Graph& graph);

/// The background that the model does not name: light where the colours stand out from it, as ink does from
/// paper, else dark. Plain behind flat models and for parallel rays (which see one direction only); behind
/// others a gradient over the height of the picture, or from the horizon up where there is ground.
Sky automatic_sky(const std::vector<Rgb>& colours, const View& view, bool figure);

/// Lets the gradient run over the height of a picture with perspective.
void span_picture(Sky& sky, const View& view);

} // namespace graftal
