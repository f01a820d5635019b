#pragma once

#include "compiler/inst/inst_hues.h"
#include "compiler/inst/inst_ink.h"

namespace graftal {

/// Takes out the objects that draw nothing, because their conditions leave no instance, and the instances of
/// such objects, with their rows in the tables. False if the root is one: nothing then changes.
bool drop_empty(Graph& graph, HueTable& hues, InkTable& inks);

} // namespace graftal
