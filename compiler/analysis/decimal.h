#pragma once

#include <string>

#include "compiler/support/big_count.h"

namespace graftal {

/// The decimal digits of a non-negative number, by halving: a million digits in about a second, where the
/// digit-by-digit way of the library takes minutes.
std::string to_decimal(const BigCount& number);

} // namespace graftal
