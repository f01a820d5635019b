#pragma once

#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

namespace graftal {

/// A broken invariant is a bug of graftal, never of a model. It is thrown so that outputs are tidied on the
/// way, and nobody catches it except main(). The text says where and why.
class BrokenInvariant : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

/// Memory that could not be had, with the stage that asked for it. Takes no more of it.
class OutOfMemory : public std::bad_alloc {
  public:
    explicit OutOfMemory(std::string_view stage) noexcept;
    const char* what() const noexcept override { return text_; }

  private:
    char text_[120];
};

/// Throws a BrokenInvariant. `context` names the stage or pass and the object, e.g. "merge_equivalent: object
/// llr".
[[noreturn]] void invariant_broken(const char* file, int line, const char* condition,
                                   std::string_view context);

/// To be called where an exception is being handled: throws it again as one that names the stage. Exceptions
/// of libraries become broken invariants; one that has a stage keeps it, and so does Cancelled.
[[noreturn]] void rethrow_in_stage(std::string_view stage);

} // namespace graftal

/// Throws a BrokenInvariant with `context` unless `condition` holds; active in every build type.
#define GRAFTAL_CHECK(condition, context)                                                                    \
    do {                                                                                                     \
        if (!(condition)) ::graftal::invariant_broken(__FILE__, __LINE__, #condition, context);              \
    } while (false)
