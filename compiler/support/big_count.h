#pragma once

#include <boost/multiprecision/cpp_int.hpp>

namespace graftal {

/// A count without a limit.
using BigCount = boost::multiprecision::cpp_int;

} // namespace graftal
