#include "compiler/support/control.h"

#include <gtest/gtest.h>

#include "compiler/support/check.h"

namespace graftal {
namespace {

TEST(CancelFlag, OneMadeFromNothingIsNeverRaised) {
    EXPECT_FALSE(CancelFlag().raised());
    EXPECT_FALSE(CancelFlag().can_be_raised());
}

TEST(WorkMeter, AsksAfterEachInterval) {
    int asked = 0;
    std::vector<std::uint64_t> told;
    const Control control{CancelFlag([&] { return ++asked > 3; }),
                          [&](const Progress& progress) { told.push_back(progress.done); }};
    WorkMeter meter(control, "stage", 10);
    std::uint64_t done = 0;
    try {
        for (; done < 1000; ++done)
            meter.add();
        FAIL() << "it was not cancelled";
    } catch (const Cancelled&) {
        EXPECT_EQ(done, 30u); // the unit that met the raised flag does not count
    }
    EXPECT_EQ(told, (std::vector<std::uint64_t>{1, 11, 21}));
    EXPECT_EQ(asked, 4);
}

TEST(WorkMeter, ACancelledStageKeepsItsKind) {
    EXPECT_THROW(
        {
            try {
                throw Cancelled();
            } catch (const std::exception&) {
                rethrow_in_stage("bounding");
            }
        },
        Cancelled);
}

} // namespace
} // namespace graftal
