#include "runtime/points/shares.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "runtime/points/draw_points.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Shares : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(directory_.create().ok()); }

    /// Sizes of the parts of a model's root in its picture, and messages about a cloud of it.
    std::vector<double> shown(const std::string& text, const char* output = "a.png") {
        const std::string path = directory_.path() + "/model.inst";
        EXPECT_TRUE(write_text(path, text).ok());
        PictureSession session(path);
        PointsOptions options;
        options.compile.view.size = {100, 100};
        options.output = directory_.path() + "/" + output;
        options.points = 100'000;
        Compilation compilation;
        const auto report = draw_points(session, options, compilation);
        said_ = compilation.diagnostics.render(compilation.sources);
        EXPECT_TRUE(report) << said_;
        inside_ = report ? report->inside : 0;
        const auto viewed = session.viewed(options.compile, compilation);
        return shown_sizes(*viewed->model, viewed->view);
    }

    TemporaryDirectory directory_;
    std::string said_;
    std::uint64_t inside_ = 0;
};

const std::string camera = "camera { location: 0, 0, 10  look_at: 0, 0, 0  angle: 40 }\n"
                           "canonical object ball { sphere }\n";

TEST_F(Shares, are_by_area_over_the_square_of_the_distance) {
    const std::vector<double> sizes = shown(
        camera + "object all { ball\n ball translate: 0, 0, -90\n ball scale: 3 translate: 9, 0, -110 }");
    ASSERT_EQ(sizes.size(), 3u);
    EXPECT_NEAR(sizes[0] / sizes[1], 100, 1e-6);
    EXPECT_NEAR(sizes[2] / sizes[1], 9 * 1e4 / (9 * 9 + 120 * 120), 1e-6);
}

TEST_F(Shares, leave_out_what_is_not_in_the_picture) {
    const std::vector<double> sizes =
        shown(camera + "object all { ball\n ball translate: 0, 0, 12\n ball translate: 50, 0, 0 }");
    ASSERT_EQ(sizes.size(), 3u);
    EXPECT_GT(sizes[0], 0);
    EXPECT_EQ(sizes[1], 0);
    EXPECT_EQ(sizes[2], 0);
    EXPECT_EQ(inside_, 100'000u);
}

TEST_F(Shares, of_hills_around_a_tree_are_those_of_the_hills_behind_it) {
    // Twelve hills with the area of 750,000 trees: one of them is in the picture, 1/8281 as near as the tree.
    const std::string model =
        camera + "canonical object hill { sphere  scale: 250 }\n"
                 "canonical object hills { repeat 12 { rotate: y, 30 } { hill translate: 0, 0, -900 } }\n"
                 "object all { ball\n hills }";
    const std::vector<double> sizes = shown(model);
    ASSERT_EQ(sizes.size(), 2u);
    EXPECT_GT(sizes[1], sizes[0]);
    EXPECT_LT(sizes[1], 40 * sizes[0]);
    EXPECT_THAT(said_, Not(HasSubstr("of the points")));
    // In space the tree has next to no area.
    shown(model, "a.ply");
    EXPECT_THAT(said_, HasSubstr("warning: 'ball' gets 0.00013 % of the points"));
}

TEST_F(Shares, of_a_part_with_a_plane_are_those_of_the_rest) {
    const std::vector<double> sizes =
        shown(camera + "canonical object floor { plane translate: 0, -2, 0\n ball translate: 0, 0, -90 }\n"
                       "object all { ball\n floor }");
    ASSERT_EQ(sizes.size(), 2u);
    EXPECT_NEAR(sizes[0] / sizes[1], 100, 1e-6);
}

TEST_F(Shares, of_many_parts_take_few_looks) {
    // A million pairs: of each, one ball is in the picture. A whole ring of them counts from its middle, 10
    // away. A pair counts from its own, at the root of 116.
    const std::vector<double> sizes =
        shown(camera + "canonical object pair { ball\n ball translate: 8, 0, 0 }\n"
                       "canonical object ring { repeat 1000 { rotate: z, 0.36 } { pair } }\n"
                       "canonical object rings { repeat 1000 { rotate: z, 0.36 } { ring } }\n"
                       "object all { rings\n pair }");
    ASSERT_EQ(sizes.size(), 2u);
    EXPECT_NEAR(sizes[0] / sizes[1], 99'000 + 901'000 * 1.16, 20'000) << "a hundred thousand looks";
}

TEST_F(Shares, are_none_where_chances_are_stated) {
    EXPECT_TRUE(
        shown(camera + "object all { ball chance: 1\n ball translate: 0, 0, -90 chance: 2 }").empty());
}

} // namespace
} // namespace graftal
