#pragma once

#include "compiler/detail/prepare.h"
#include "compiler/povray/cut.h"
#include "compiler/support/control.h"

namespace graftal {

/// cut_prepared() under a control, which follows the pieces that are chosen, unfolded and baked, in all
/// tries.
std::optional<Cut> cut_prepared(const Graph& graph, const PreparedCut& prepared, const View& view,
                                const DetailOptions& detail, Diagnostics& diagnostics,
                                const CutOptions& options, const Control& control);

} // namespace graftal
