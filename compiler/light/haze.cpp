#include "compiler/light/haze.h"

#include "compiler/light/formulas.h"

namespace graftal {

double Haze::left_after(Vec3 from, Vec3 direction, double length) const {
    const double begin = (from.y - base) / height; // 0 where it is even
    return formulas::left_after_haze(begin, begin + length * direction.y / height, length, distance);
}

} // namespace graftal
