#include "runtime/render/video.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

TEST(Video, TheProgramsProgressIsHeardAndIsNoMessage) {
    TemporaryDirectory folder;
    ASSERT_TRUE(folder.create().ok());
    const std::string program = folder.path() + "/ffmpeg";
    const auto make = [&](const std::string& end, std::vector<std::size_t>& done) {
        EXPECT_TRUE(write_text(program, "#!/bin/sh\nprintf 'fra' >&2\nprintf 'me=3\\nfps=0.0\\n' >&2\n"
                                        "printf 'frame=7\\nbitrate= 1.5kbits/s\\nbroken=no\\n' >&2\n" +
                                            end)
                        .ok());
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        FrameStore frames(folder.path() + "/frames", 9);
        EXPECT_TRUE(frames.create().ok());
        return write_video(folder.path() + "/a.mp4", frames, {}, {},
                           [&](std::size_t frame) { done.push_back(frame); });
    };
    const std::string saved = std::getenv("PATH");
    ::setenv("PATH", folder.path().c_str(), 1);
    std::vector<std::size_t> done;
    const Status made = make("for name; do :; done; echo film >\"${name#file:}\"\n", done);
    const Status failed = make("echo '[x] frame=8 is bad' >&2\necho progress=end >&2\nexit 4\n", done);
    ::setenv("PATH", saved.c_str(), 1);
    EXPECT_TRUE(made.ok()) << made.message();
    EXPECT_EQ(failed.message(), "'ffmpeg' failed with status 4: [x] frame=8 is bad");
    EXPECT_EQ(done, (std::vector<std::size_t>{3, 7, 3, 7}));
}

} // namespace
} // namespace graftal
