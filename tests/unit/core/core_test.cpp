// The core alone, as a browser has it: models are texts in memory, one thread works, pictures are floats.

#include <algorithm>

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "compiler/support/files.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/picture_tracer.h"

namespace graftal {
namespace {

class Core : public ::testing::Test {
  protected:
    Core() {
        files_.set("trees/oak.inst", "use leaf = \"../leaf.rifs\"\n"
                                     "let height = 2\n"
                                     "object oak { cylinder scale: 0.1, height, 0.1\n"
                                     "             leaf translate: 0, height, 0 }\n");
        files_.set("leaf.rifs",
                   "rifs leaf {\n  map a { scale 0.5 }\n  map b { scale 0.5 translate 0.5, 0, 0 }\n"
                   "  map c { scale 0.5 translate 0, 0.5, 0 }\n}\n");
        options_.view.size = {64, 48};
    }

    Image picture() {
        Compilation compilation;
        const auto viewed = session_.viewed(options_, compilation);
        const auto prepared = viewed ? session_.prepared(options_, compilation) : nullptr;
        EXPECT_TRUE(prepared) << compilation.diagnostics.render(compilation.sources)
                              << compilation.status.message();
        if (!prepared) return {};
        const TraceModel model(prepared, viewed->view, resolved(options_.detail, *viewed));
        Image image{options_.view.size.width, options_.view.size.height, 3, {}};
        image.pixels.resize(3 * 64 * 48);
        std::uint64_t pixels = 0;
        const SerialWorkers workers;
        TraceControl control;
        control.workers = &workers;
        control.on_tile = [&](const Tile& tile) { pixels += tile.pixels(); };
        EXPECT_TRUE(PictureTracer(model).trace({}, control, image));
        EXPECT_EQ(pixels, 64u * 48u);
        return image;
    }

    MemoryFiles files_;
    Session session_{"trees/oak.inst", files_};
    StageOptions options_;
};

TEST_F(Core, RendersTextsThatLieInMemory) {
    const Image image = picture();
    const auto [least, most] = std::ranges::minmax(image.pixels);
    EXPECT_GT(most, least + 0.1f) << "there is something to see";
}

TEST_F(Core, AChangedParameterParsesNothing) {
    const Image first = picture();
    for (int i = 1; i <= 20; ++i) {
        options_.lower.set["height"] = 2 + 0.1 * i;
        EXPECT_NE(picture(), first);
    }
    EXPECT_EQ(session_.runs().parsed, 2u) << "the model and the one that it uses";
    EXPECT_EQ(session_.runs().lowered, 21u);
}

TEST_F(Core, AChangedFileIsParsedAlone) {
    const Image first = picture();
    files_.set("leaf.rifs",
               "rifs leaf {\n  map a { scale 0.5 }\n  map b { scale 0.7 translate 0.5, 0, 0 }\n}\n");
    EXPECT_EQ(picture(), first) << "nobody has said that it changed";
    session_.reload();
    EXPECT_NE(picture(), first);
    EXPECT_EQ(session_.runs().parsed, 3u);
}

TEST_F(Core, AFileThatIsNotThereIsNamed) {
    files_.remove("leaf.rifs");
    Compilation compilation;
    EXPECT_FALSE(session_.viewed(options_, compilation));
    EXPECT_NE(compilation.diagnostics.render(compilation.sources).find("cannot open 'leaf.rifs'"),
              std::string::npos);
}

} // namespace
} // namespace graftal
