#include "compiler/detail/shell/sizes.h"

#include <algorithm>

namespace graftal {

bool is_crowded(double leaves, double detail, bool flat) {
    // In a plane a ray goes through all leaves of a cell. In space, where it goes through a row of cells, the
    // first ends it.
    constexpr double leaves_a_sheet_cell = 256, leaves_a_cell = 32;
    const double most =
        flat ? leaves_a_sheet_cell * detail * detail : leaves_a_cell * detail * detail * detail;
    return leaves > std::max(most, leaves_a_cell);
}

} // namespace graftal
