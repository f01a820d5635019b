#pragma once

#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/scene.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// A card: a flat cube that shows a picture of a model, in the model's place and as large. It stands for
/// models that are about flat, in a plane z = const, such as leaves: as a terminal, from the size on that
/// tells no difference.

/// The view that a card's picture is made by: along -z, in parallel rays, with all of the box in it and a
/// margin.
View card_view(const Box& box, ImageSize size);

/// An `.inst` model of the card. `picture`: the file's name, looked for beside the model; requires
/// is_card_picture(). The finish is that of the material, if there is just one.
std::string card_text(const std::string& picture, const Box& box, ImageSize size,
                      const std::vector<Material>& materials);

/// Whether a model's text can name this file.
bool is_card_picture(const std::string& picture);

} // namespace graftal
