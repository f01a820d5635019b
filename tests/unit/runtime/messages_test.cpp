#include "runtime/povray/messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using Kind = PovrayMessage::Kind;
using Stage = PovrayProgress::Stage;
using testing::ElementsAre;

struct Reading {
    PovrayLog log;
    std::vector<PovrayProgress> progress;
};

/// Feeds the text in pieces of the given size, as a pipe may cut it.
Reading read(std::string_view text, std::size_t piece = 1000) {
    Reading reading;
    PovrayMessageReader reader([&](const PovrayProgress& p) { reading.progress.push_back(p); });
    for (std::size_t at = 0; at < text.size(); at += piece)
        reader.feed(text.substr(at, piece));
    reader.finish();
    reading.log = reader.log();
    return reading;
}

constexpr const char* complete_run =
    "==== [Parsing...] ==========================================================\n"
    "@@10\n"
    "Parsing 8748K tokens\rParsing 14623K tokens\r@@100\n"
    "----------------------------------------------------------------------------\n"
    "Parser Statistics\n"
    "----------------------------------------------------------------------------\n"
    "Finite Objects:        65536\n"
    "Infinite Objects:          1\n"
    "Light Sources:             2\n"
    "Total:                 65539\n"
    "----------------------------------------------------------------------------\n"
    "Parser Time\n"
    "  Parse Time:       0 hours  1 minutes  2 seconds (62.347 seconds)\n"
    "              using 1 thread(s) with 62.100 CPU-seconds total\n"
    "  Bounding Time:    0 hours  0 minutes  1 seconds (1.250 seconds)\n"
    "              using 1 thread(s) with 1.200 CPU-seconds total\n"
    "==== [Rendering...] ========================================================\n"
    "Rendered 1024 of 4096 pixels (25%)\rRendered 4096 of 4096 pixels (100%)\r\n"
    "Render Time:\n"
    "  Photon Time:      No photons\n"
    "  Radiosity Time:   No radiosity\n"
    "  Trace Time:       0 hours  0 minutes  0 seconds (0.501 seconds)\n"
    "              using 2 thread(s) with 0.900 CPU-seconds total\n"
    "POV-Ray finished\n\n";

TEST(Messages, CompleteRunGivesTimesCountsAndTheEnd) {
    const PovrayLog log = read(complete_run).log;
    EXPECT_TRUE(log.finished);
    EXPECT_TRUE(log.messages.empty());
    EXPECT_EQ(log.parse_seconds, 62.347);
    EXPECT_EQ(log.bounding_seconds, 1.25);
    EXPECT_EQ(log.trace_seconds, 0.501);
    EXPECT_EQ(log.finite_objects, 65536u);
}

TEST(Messages, ProgressGoesThroughTheStages) {
    EXPECT_THAT(read(complete_run).progress,
                ElementsAre(PovrayProgress{Stage::parsing, std::nullopt}, PovrayProgress{Stage::parsing, 0.1},
                            PovrayProgress{Stage::bounding, std::nullopt},
                            PovrayProgress{Stage::rendering, 0.0}, PovrayProgress{Stage::rendering, 0.25},
                            PovrayProgress{Stage::rendering, 1.0}));
}

TEST(Messages, ReadingDoesNotDependOnHowThePipeCutsTheText) {
    const Reading whole = read(complete_run);
    for (const std::size_t piece : {1, 2, 7, 79}) {
        const Reading cut = read(complete_run, piece);
        EXPECT_EQ(cut.progress, whole.progress) << piece;
        EXPECT_EQ(cut.log.trace_seconds, whole.log.trace_seconds) << piece;
        EXPECT_EQ(cut.log.last_lines, whole.log.last_lines) << piece;
    }
}

TEST(Messages, WrappedErrorIsOneMessage) {
    const PovrayLog log =
        read("File 'scene.pov' line 3: Parse Error: Expected 'object', undeclared identifier\n"
             " 'Undefined_thing' found instead\n"
             "Fatal error in parser: Cannot parse input.\n"
             "Render failed\n\n",
             5)
            .log;
    EXPECT_THAT(
        log.messages,
        ElementsAre(PovrayMessage{Kind::error, "scene.pov", 3,
                                  "Expected 'object', undeclared identifier 'Undefined_thing' found instead"},
                    PovrayMessage{Kind::error, "", 0, "Fatal error in parser: Cannot parse input."}));
    EXPECT_THAT(log.last_lines, ElementsAre("Render failed"));
    EXPECT_FALSE(log.finished);
}

TEST(Messages, TwoMessagesInARowStayTwo) {
    const PovrayLog log =
        read("File 'img.pov' line 2: Possible Parse Error: Cannot find file 'nope.png', even\n"
             " after trying to append file type extension.\n"
             "File 'img.pov' line 2: Possible Parse Error: Cannot find image file.\n")
            .log;
    EXPECT_THAT(
        log.messages,
        ElementsAre(
            PovrayMessage{Kind::possible_error, "img.pov", 2,
                          "Cannot find file 'nope.png', even after trying to append file type extension."},
            PovrayMessage{Kind::possible_error, "img.pov", 2, "Cannot find image file."}));
}

TEST(Messages, WordCutAtTheWidthOfTheConsoleIsJoined) {
    const std::string head = "Parse Error: Cannot open include file ";
    const std::string name(60, 'x');
    const std::string line = head + name;
    const PovrayLog log = read(line.substr(0, 79) + "\n" + line.substr(79) + "\nRender failed\n").log;
    ASSERT_EQ(log.messages.size(), 1u);
    EXPECT_EQ(log.messages[0].text, "Cannot open include file " + name);
    EXPECT_EQ(log.messages[0].line, 0);
}

TEST(Messages, WarningsThatMakeThePictureWrongAreNoticedEvenWhenWrapped) {
    const PovrayLog matrix =
        read("File 'mat.pov' line 4: Parse Warning: Illegal matrix column: Scale by 0.0.\n"
             " Changed to 1.0.\n")
            .log;
    EXPECT_TRUE(matrix.illegal_matrix);
    EXPECT_THAT(matrix.messages,
                ElementsAre(PovrayMessage{Kind::warning, "mat.pov", 4,
                                          "Illegal matrix column: Scale by 0.0. Changed to 1.0."}));
    const PovrayLog wrapped =
        read("File 'a_rather_long_name_of_a_scene.pov' line 123456: Parse Warning: Illegal\n"
             " matrix column: Scale by 0.0. Changed to 1.0.\n")
            .log;
    EXPECT_TRUE(wrapped.illegal_matrix);
    EXPECT_TRUE(read("File 'empty.pov' line 1: Parse Warning: No objects in scene.\n").log.no_objects);
}

TEST(Messages, MessageAtTheVeryEndWithoutALineEndIsKept) {
    EXPECT_EQ(read("File 's.pov' line 2: Parse Error: Out of memory.").log.messages.size(), 1u);
}

TEST(Messages, AMillionWarningsAreNotAMillionMessages) {
    std::string text;
    for (int i = 0; i < 100'000; ++i)
        text += "File 'x.pov' line 7: Parse Warning: Camera vectors are not perpendicular.\n";
    text += "File 'x.pov' line 9: Parse Warning: Illegal matrix column: Scale by 0.0.\n";
    const PovrayLog log = read(text).log;
    EXPECT_EQ(log.messages.size(), PovrayLog::max_messages);
    EXPECT_TRUE(log.illegal_matrix) << "dropped messages must still be understood";
}

TEST(Messages, AnErrorBehindAHundredWarningsIsKept) {
    std::string text;
    for (int i = 0; i < 500; ++i)
        text += "File 'x.pov' line 7: Parse Warning: Degenerate triangle. Please remove.\n";
    for (int i = 0; i < 500; ++i)
        text += "File 'x.pov' line 8: Possible Parse Error: Cannot find image file.\n";
    text += "File 'x.pov' line 9: Parse Error: Out of memory.\n";
    const PovrayLog log = read(text).log;
    ASSERT_EQ(log.messages.size(), PovrayLog::max_messages);
    EXPECT_EQ(log.messages.back(), (PovrayMessage{Kind::error, "x.pov", 9, "Out of memory."}));
}

TEST(Messages, EndlessLineIsBounded) {
    PovrayMessageReader reader;
    const std::string block(1 << 16, 'x');
    for (int i = 0; i < 100; ++i)
        reader.feed(block);
    reader.finish();
    ASSERT_EQ(reader.log().last_lines.size(), 1u);
    EXPECT_LE(reader.log().last_lines[0].size(), std::size_t{1} << 16);
}

TEST(Messages, GarbageIsNoProgress) {
    const Reading reading = read("@@\n@@-3\n@@101\n@@9999999999\nRendered 5\nRendered 1 of 0 pixels\n"
                                 "Rendered x of y pixels\nFile 'x' line : Parse Error: a\nFile 'x\n");
    EXPECT_TRUE(reading.progress.empty());
    EXPECT_TRUE(reading.log.messages.empty());
}

TEST(Messages, BinaryNoiseIsSurvived) {
    std::string noise;
    std::uint32_t state = 1;
    for (int i = 0; i < 200'000; ++i) {
        state = state * 1664525u + 1013904223u;
        noise += static_cast<char>(state >> 24);
    }
    EXPECT_FALSE(read(noise, 17).log.finished);
}

} // namespace
} // namespace graftal
