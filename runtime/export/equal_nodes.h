#pragma once

#include "compiler/unfolded/scene.h"

namespace graftal {

/// Makes one node of those that are equal: in name, shape, look and parts. A scene tells sizes apart to
/// choose how fine curved surfaces are; nodes without such surfaces then differ in nothing. Each place of the
/// others leads to the first of them in `masters_first`, which must be sorted and is sorted again; the others
/// stay, without a place. Requires resolved looks. O(parts).
void unite_equal_nodes(UnfoldedScene& scene);

} // namespace graftal
