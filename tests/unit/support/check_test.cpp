#include "compiler/support/check.h"

#include <gtest/gtest.h>

#include "compiler/support/status.h"
#include "tests/unit/broken_invariant.h"

namespace graftal {
namespace {

TEST(Check, SaysWhereAndWhatAndForWhom) {
    const int one = 1;
    EXPECT_BROKEN(GRAFTAL_CHECK(one == 2, "merge_equivalent: object llr"),
                  "^internal error at .*check_test.cpp:[0-9]+: 'one == 2' does not hold "
                  "\\(merge_equivalent: object llr\\)$");
}

/// What `fault` becomes in a stage.
template<typename Fault> void in_stage(const Fault& fault) {
    try {
        throw fault;
    } catch (const std::exception&) {
        rethrow_in_stage("cut");
    }
}

TEST(Check, ExceptionsNameTheStage) {
    EXPECT_BROKEN(in_stage(std::length_error("too long")), "^internal error in the stage cut: too long$");
    EXPECT_BROKEN(in_stage(BrokenInvariant("lower: x")), "^lower: x$");
    EXPECT_THAT([] { in_stage(std::bad_alloc()); },
                testing::ThrowsMessage<OutOfMemory>("out of memory in the stage cut"));
    EXPECT_THAT([] { in_stage(OutOfMemory("lower")); },
                testing::ThrowsMessage<OutOfMemory>("out of memory in the stage lower"));
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
