#include "compiler/support/control.h"

#include <gtest/gtest.h>

#include "compiler/support/check.h"

namespace graftal {
namespace {

TEST(CancelFlag, OneMadeFromNothingIsNeverRaised) {
    EXPECT_FALSE(CancelFlag().raised());
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

TEST(WorkMeter, ChargesWhatItCountsAndEndsTheStageAtTheLimit) {
    StageWork work(1.0, 0.25);
    const Control control{{}, {}, &work};
    WorkMeter meter(control, "passes", 1, 0.125);
    meter.add(2);
    EXPECT_EQ(work.seconds(), 0.5);
    meter.add(1, 0.25);
    EXPECT_EQ(meter.left(), 0.25);
    meter.charge(0.25);
    EXPECT_EQ(work.left(), 0);
    try {
        meter.add();
        FAIL() << "it went on";
    } catch (const OutOfWork& fault) {
        EXPECT_EQ(fault.stage(), "passes");
        EXPECT_EQ(fault.limit_seconds(), 1);
    }
}

TEST(WorkMeter, SettlesInTheEndWhatItOwes) {
    StageWork work(1.0);
    const Control control{{}, {}, &work};
    {
        WorkMeter meter(control, "lower", 1000, 0.125);
        for (int unit = 0; unit < 9; ++unit)
            meter.add();
        EXPECT_EQ(work.seconds(), 0.125) << "asked at the first unit only";
        EXPECT_EQ(meter.left(), -0.125);
    }
    EXPECT_EQ(work.seconds(), 1.125);
    EXPECT_EQ(work.left(), 0);
}

TEST(WorkMeter, WithoutAnAccountThereIsNoLimit) {
    WorkMeter meter(no_control(), "lower", 1, 1e300);
    meter.add(1000);
    EXPECT_EQ(meter.left(), StageWork::unlimited);
}

TEST(WorkMeter, AStageOutOfWorkKeepsItsKind) {
    EXPECT_THROW(
        {
            try {
                throw OutOfWork("bounding", 5);
            } catch (const std::exception&) {
                rethrow_in_stage("bounding");
            }
        },
        OutOfWork);
}

} // namespace
} // namespace graftal
