// An export that is cancelled ends as "interrupted", wherever it is, and leaves no file.

#include <atomic>
#include <memory>

#include <gtest/gtest.h>

#include "tests/unit/export/exporting.h"

namespace graftal {
namespace {

const std::string triangles = // which a plane holds
    "rifs m {\n"
    "  map a { scale 1/2 translate <-1/2, 0, 0> }\n"
    "  map b { scale 1/2 translate <1/2, 0, 0> }\n"
    "  map c { scale 1/2 translate <0, 1/2, 0> }\n"
    "  terminal triangle\n"
    "}\n";

TEST(ExportCancelled, AtEachOfManyMomentsItIsInterruptedAndLeavesNothing) {
    for (const ExportFormat& format : export_formats()) {
        SCOPED_TRACE(format.extension);
        const std::string name = "out" + std::string(format.extension);
        int interrupted = 0;
        for (int moment = 1, step = 1;; moment += step, step += moment / 2) {
            // The flag counts how often it is asked: no clock decides.
            const auto asked = std::make_shared<std::atomic<int>>(0);
            Exporting exporting("m.rifs", format.extension == ".svg" ? triangles : cubes);
            exporting.options.compile.lower.steps = 4;
            exporting.set_cancel(CancelFlag([asked, moment] { return ++*asked >= moment; }));
            const std::optional<std::string> written = exporting.to(name);
            if (written) break;
            ASSERT_EQ(exporting.compilation.status.message(), "interrupted") << moment << exporting.said();
            ASSERT_EQ(exporting.files(), "m.rifs") << moment;
            ++interrupted;
        }
        EXPECT_GE(interrupted, 3);
    }
}

} // namespace
} // namespace graftal
