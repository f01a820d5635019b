// Devices of Vulkan that fail at any time, by tests/bench/vulkan_shim.cpp: the processors draw the picture,
// and graftal says why. Without a device it says how to go on.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class GpuFaults : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
#ifndef GRAFTAL_VULKAN_SHIM
        GTEST_SKIP() << "sanitizers find faults in drivers";
#else
        write("m.rifs", "rifs m {\n map a { scale 1/2 }\n map b { scale 1/2 translate <1,0,0> }\n"
                        " map c { scale 1/2 translate <0,1,0> }\n}\n");
        shell("mkdir ../loader && ln -s '" GRAFTAL_VULKAN_SHIM "' ../loader/libvulkan.so.1");
#endif
    }

    /// `fault`: FUNCTION:N:RESULT, or "".
    RunResult draw(const std::string& fault, const std::string& words = "m.rifs") const {
        return shell("LD_LIBRARY_PATH=$PWD/../loader VULKAN_FAULT=" + fault +
                     " GALLIVM_PERF=nopt timeout 100 \"$graftal\" render --engine gpu --device 0 " + words +
                     " --size 16x12 --samples 2 -o a.png");
    }
};

TEST_F(GpuFaults, AreNotesOnAPictureByTheProcessors) {
    ASSERT_THAT(draw("").err, Not(HasSubstr("not the GPU")));
    const struct {
        std::string fault, said;
    } faults[] = {
        {"vkCreateDevice:1:-3", "not the GPU: GPU: opening the device failed (Vulkan's result -3)"},
        {"vkAllocateMemory:1:-2", "the device has no memory left"},
        {"vkAllocateMemory:5:-2", "the device has no memory left"},
        {"vkCreateComputePipelines:1:-1", "making the kernel: no memory is left"},
        {"vkQueueSubmit:2:-4", "running the kernel: the device was lost"},
        {"vkQueueSubmit:14:-4", "running the kernel: the device was lost"},
        {"vkWaitForFences:14:-4", "running the kernel: the device was lost"},
        {"vkWaitForFences:14:2", "the device takes too long for a part of the picture"},
    };
    for (const auto& [fault, said] : faults) {
        shell("rm -f a.png");
        const RunResult result = draw(fault);
        EXPECT_EQ(result.status, 0) << fault << result.err;
        EXPECT_THAT(result.err, HasSubstr(said)) << fault;
        EXPECT_EQ(picture("a.png").width, 16) << fault;
    }
}

TEST_F(GpuFaults, OfOneOfSeveralDevicesLeaveThePictureToTheProcessors) {
    const RunResult drawn = draw("", "m.rifs --device 0,0");
    EXPECT_THAT(drawn.err, HasSubstr("on 2 devices: llvmpipe"));
    const RunResult lost = draw("vkQueueSubmit:28:-4", "m.rifs --device 0,0");
    EXPECT_EQ(lost.status, 0) << lost.err;
    EXPECT_THAT(lost.err, HasSubstr("not the GPU: GPU: running the kernel: the device was lost"));
    EXPECT_EQ(picture("a.png").width, 16);
    EXPECT_THAT(draw("", "m.rifs --device 0,7").err, HasSubstr("there is no device number 7"));
}

TEST_F(GpuFaults, ADriverOfTheProcessorsIsNoCardUnlessAskedFor) {
    const RunResult result =
        shell("timeout 100 \"$graftal\" render --engine gpu m.rifs --size 16x12 -o a.png");
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.err,
                HasSubstr("not the GPU: there is no graphics card ('--device 0' draws by llvmpipe"));
}

TEST_F(GpuFaults, WithoutALoaderOrADeviceTheProcessorsDrawToo) {
    const RunResult none = draw("vkCreateInstance:1:-9");
    EXPECT_EQ(none.status, 0);
    EXPECT_THAT(none.err, HasSubstr("not the GPU: GPU: no driver of Vulkan 1.2 is installed"));
    EXPECT_EQ(draw("vkCreateInstance:1:-9", "m.rifs --engine auto").status, 0);
    shell("rm -f ../loader/libvulkan.so.1 && touch ../loader/libvulkan.so.1");
    const RunResult missing = draw("");
    EXPECT_EQ(missing.status, 0);
    EXPECT_THAT(missing.err, HasSubstr("not the GPU: GPU: no Vulkan loader (libvulkan.so.1) is installed"));
}

/// A device that fails, or cannot do it, leaves all points to the processors.
TEST_F(GpuFaults, OfPointsAreNotesToo) {
    const auto points = [&](const std::string& fault, const std::string& words = "m.rifs") {
        shell("rm -f a.png");
        return shell("LD_LIBRARY_PATH=$PWD/../loader VULKAN_FAULT=" + fault +
                     " timeout 100 \"$graftal\" points --engine gpu " + words +
                     " --size 16x12 --points 100000 -o a.png");
    };
    const RunResult drawn = points("", "m.rifs --device 0");
    EXPECT_THAT(drawn.err, Not(HasSubstr("not the GPU")));
    EXPECT_THAT(drawn.err, HasSubstr("million per second by llvmpipe"));
    write("o.rifs", "orbit o { x = 1 - y + abs(x)  y = x }\n");
    const struct {
        std::string fault, words, said;
    } faults[] = {
        {"vkCreateDevice:1:-3", "m.rifs --device 0", "GPU: opening the device failed (Vulkan's result -3)"},
        {"vkAllocateMemory:8:-2", "m.rifs --device 0", "the device has no memory left"},
        {"vkCreateComputePipelines:1:-1", "m.rifs --device 0", "making the kernel: no memory is left"},
        {"vkQueueSubmit:20:-4", "m.rifs --device 0", "running the kernel: the device was lost"},
        {"vkCreateInstance:1:-9", "m.rifs --device 0", "GPU: no driver of Vulkan 1.2 is installed"},
        {"", "m.rifs --device 9", "GPU: there is no device number 9"},
        {"", "m.rifs", "there is no graphics card ('--device 0' draws by llvmpipe"},
        {"", "m.rifs --device 0 --camera 'look_at=0.3,0.3,0 width=1e-6'", "single precision"},
        {"", "o.rifs --device 0", "one map has one orbit"},
    };
    for (const auto& [fault, words, said] : faults) {
        const RunResult result = points(fault, words);
        EXPECT_EQ(result.status, 0) << fault << words << result.err;
        EXPECT_THAT(result.err, HasSubstr("the processors make these points, not the GPU: "))
            << fault << words;
        EXPECT_THAT(result.err, HasSubstr(said)) << fault << words;
        EXPECT_EQ(picture("a.png").width, 16) << fault << words;
    }
    EXPECT_EQ(points("vkCreateInstance:1:-9", "m.rifs --engine auto").status, 0);
}

TEST_F(GpuFaults, ManyInstancesAreDrawnOrLeftToTheProcessors) {
    write("cells.inst",
          "canonical object cell { cube scale: 0.3 }\nobject many { scatter: cell count: 300000 "
          "over: 0, 0, 1000, 1000 by: uniform }\n");
    const RunResult drawn = draw("", "cells.inst --plain-light");
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_THAT(drawn.err, Not(HasSubstr("not the GPU")));
    shell("sed -i s/300000/50000/ cells.inst");
    const RunResult left = draw("", "cells.inst --plain-light --memory 20M");
    EXPECT_EQ(left.status, 0) << left.err;
    EXPECT_THAT(left.err, HasSubstr("its kernel does not know 50000 instances within 20 MiB"));
}

} // namespace
} // namespace graftal
