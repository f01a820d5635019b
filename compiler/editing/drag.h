#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/maps/contraction_check.h"
#include "compiler/editing/text_edit.h"
#include "compiler/support/affine.h"

namespace graftal {

/// A part of a model that the pointer drags. Places are those of the model.
struct DraggedPart {
    std::vector<std::uint32_t> instances;  ///< on the way from the root: their numbers in their objects
    Vec3 from{0.0};                        ///< a point of the part, or near it
    Vec3 to{0.0};                          ///< where it is wanted
    std::optional<std::uint32_t> number{}; ///< first byte of the number to change; nothing: the best one
    double grain = 0;                      ///< a length that the hand can tell; 0: a fiftieth of the way
};

struct DragChange {
    std::vector<TextEdit> edits; ///< one number; empty where it is refused
    std::string refusal;         ///< "": the text changes
    std::uint32_t number = 0;    ///< first byte of the number
    Vec3 point{0.0};             ///< where the point lies after the change
};

/// Changes one number of an L-system so that the point of a part comes as near to the place as that number
/// can bring it: an argument of a turtle's symbol, in a rule that made the part, or a `let` or an angle that
/// such a symbol reads. Of those that bring it near, the one of the last rule on the way is taken; one that
/// only spreads chance (chance_spread.h) is taken where no other moves the part. Comments and layout stay.
/// Lowers the model once for each number that it tries, and throws Cancelled and OutOfWork as that does.
DragChange drag_part(const Document& document, const DraggedPart& part, const EditContext& context = {});

} // namespace graftal
