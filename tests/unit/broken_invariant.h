#pragma once

#include <gmock/gmock.h>

#include "compiler/support/check.h"

/// Expects that `statement` breaks an invariant and says so in a text with this POSIX pattern in it.
#define EXPECT_BROKEN(statement, pattern)                                                                    \
    EXPECT_THAT([&] { statement; },                                                                          \
                ::testing::ThrowsMessage<::graftal::BrokenInvariant>(::testing::ContainsRegex(pattern)))
