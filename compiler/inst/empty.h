#pragma once

#include "compiler/inst/hues.h"
#include "compiler/inst/ink.h"

namespace graftal {

/// Takes out the objects that draw nothing, because their conditions leave no instance, and the instances of
/// such objects, with their rows in the tables. False if the root is one: nothing then changes.
bool drop_empty(Graph& graph, HueTable& hues, InkTable& inks);

} // namespace graftal
