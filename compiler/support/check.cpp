#include "compiler/support/check.h"

#include <cstdio>
#include <cstdlib>

namespace graftal {

void invariant_broken(const char* file, int line, const char* condition, std::string_view context) {
    std::fprintf(stderr, "graftal: internal error at %s:%d: '%s' does not hold (%.*s)\n", file, line,
                 condition, static_cast<int>(context.size()), context.data());
    std::abort();
}

} // namespace graftal
