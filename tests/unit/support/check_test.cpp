#include "compiler/support/check.h"

#include <gtest/gtest.h>

#include "compiler/support/status.h"

namespace graftal {
namespace {

TEST(CheckDeath, SaysWhereAndWhatAndForWhom) {
    const int one = 1;
    EXPECT_DEATH(GRAFTAL_CHECK(one == 2, "merge_equivalent: object llr"),
                 "graftal: internal error at .*check_test.cpp:[0-9]+: 'one == 2' does not hold "
                 "\\(merge_equivalent: object llr\\)");
}

TEST(Check, EvaluatesItsConditionOnceAndGoesOn) {
    int count = 0;
    GRAFTAL_CHECK(++count == 1, "once");
    EXPECT_EQ(count, 1);
}

TEST(Status, SuccessHasNoMessage) {
    EXPECT_TRUE(Status().ok());
    const Status failed = Status::failure("cannot open 'x': no");
    EXPECT_FALSE(failed.ok());
    EXPECT_EQ(failed.message(), "cannot open 'x': no");
}

} // namespace
} // namespace graftal
