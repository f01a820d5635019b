#pragma once

#include <string_view>

namespace graftal {

/// Ends the process after printing where and why. A broken invariant is a bug of graftal, never of a model.
/// `context` names the stage or pass and the object, e.g. "merge_equivalent: object llr".
[[noreturn]] void invariant_broken(const char* file, int line, const char* condition,
                                   std::string_view context);

} // namespace graftal

/// Aborts with `context` unless `condition` holds; active in every build type.
#define GRAFTAL_CHECK(condition, context)                                                                    \
    do {                                                                                                     \
        if (!(condition)) ::graftal::invariant_broken(__FILE__, __LINE__, #condition, context);              \
    } while (false)
