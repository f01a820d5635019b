#include "compiler/support/check.h"

#include <cstdio>

#include <fmt/format.h>

#include "compiler/support/control.h"

namespace graftal {

OutOfMemory::OutOfMemory(std::string_view stage) noexcept {
    std::snprintf(text_, sizeof text_, "out of memory in the stage %.*s", static_cast<int>(stage.size()),
                  stage.data());
}

void invariant_broken(const char* file, int line, const char* condition, std::string_view context) {
    throw BrokenInvariant(
        fmt::format("internal error at {}:{}: '{}' does not hold ({})", file, line, condition, context));
}

void rethrow_in_stage(std::string_view stage) {
    try {
        throw;
    } catch (const BrokenInvariant&) {
        throw;
    } catch (const Cancelled&) {
        throw;
    } catch (const OutOfWork&) {
        throw;
    } catch (const OutOfMemory&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw OutOfMemory(stage);
    } catch (const std::exception& fault) {
        throw BrokenInvariant(fmt::format("internal error in the stage {}: {}", stage, fault.what()));
    }
}

} // namespace graftal
