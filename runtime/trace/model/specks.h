#pragma once

#include "runtime/trace/model/lanes.h"

namespace graftal {

struct TraceModel;

/// Four parts of what stands for a set without area, in its node's frame; each is drawn as wide as the view
/// asks (least_width.h). They tell soon that a ray misses all of them.
struct SpeckLanes {
    Double4 middle[3];  ///< by axis; no numbers in lanes that hold no part
    Double4 normal[3];  ///< of a part in a plane; else 0
    Double4 ball;       ///< 0 for a part in a plane, else 1
    Double4 radius;     ///< of a ball about the part
    Double4 side[3][3]; ///< of a triangle, away from its middle: it reaches half its radius there; else 0
    Double4 reach;      ///< half widths that a widened part may reach from its middle, as a share of
                        ///< TraceModel::widest
};

/// Adds the specks of all nodes that have such parts and no others.
void add_specks(TraceModel& model);

} // namespace graftal
