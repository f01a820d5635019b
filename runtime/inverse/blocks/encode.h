#pragma once

#include <functional>

#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/inverse/blocks/block_map.h"
#include "runtime/inverse/blocks/planes.h"

namespace graftal {

struct BlockCoding {
    double tolerance = 8; ///< squared: the squared error, in levels, that a bit has to save
    double seconds = 30;  ///< of one processor, by counted work
};

struct BlocksFound {
    BlockPicture picture;
    double seconds = 0; ///< of counted work
};

/// Partitioned iterated function systems whose attractors are near the planes of a picture. For each range
/// block of each side, the domain and the isometry with the least error are looked for, by the products of
/// all with all: 16 means of each block, less their mean. The eight best are compared pixel by pixel, with
/// the numbers as they are stored. Then each square of the quadtree, from below, is the cheaper of one block
/// and its quarters: squared error + lambda * bits. The pool has as many domains as the work allows.
///
/// The result depends on picture and coding, not on the number of workers. Throws Cancelled, and OutOfWork
/// where not even the smallest pool is affordable.
BlocksFound find_blocks(const PicturePlanes& picture, const BlockCoding& coding, const Workers& workers,
                        const CancelFlag& cancel, const std::function<void(double)>& on_progress);

} // namespace graftal
