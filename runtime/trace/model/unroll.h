#pragma once

#include "runtime/trace/model/trace_model.h"

namespace graftal {

/// Adds the unrollings of a model that has all else: of the nodes next to the root first, as long as they are
/// worth their memory, some MiB at most. The flag ends it by Cancelled.
void add_unrollings(TraceModel& model, const CancelFlag& cancel);

} // namespace graftal
