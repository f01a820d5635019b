#pragma once

#include <string>
#include <string_view>

namespace graftal::v1 {

/// A message of the compiler with the options that it names written as functions and settings of the library:
/// "--error" as "error_px()", and "'--steps 5'" as "'steps(5)'". Options that only the program has stay.
std::string in_library_words(std::string_view message);

} // namespace graftal::v1
