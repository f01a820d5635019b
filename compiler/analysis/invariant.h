#pragma once

#include "compiler/analysis/contraction.h"
#include "compiler/analysis/cycle_graph.h"
#include "compiler/analysis/outer.h"

namespace graftal {

/// First bounds of the objects of a cyclic component: ellipsoids in the metrics of the certificate which all
/// instances map into each other, and one point each. They are true, if wide; the search for support
/// functions starts from them. Requires a certificate that holds, and bounds of all masters outside.
void bound_cycle(const CycleGraph& cycle, const Components& components,
                 const ContractionCertificate& certificate, Outers& outers);

} // namespace graftal
