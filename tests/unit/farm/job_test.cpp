#include "runtime/farm/job.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/farm/job_status.h"
#include "runtime/farm/model_copy.h"
#include "runtime/farm/slurm.h"
#include "runtime/farm/task_records.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"

namespace graftal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

class JobFiles : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(directory_.create().ok());
        fs::create_directories(folder().parts());
        fs::create_directories(folder().tasks());
    }
    JobFolder folder() const { return JobFolder(directory_.path()); }
    static void write(const std::string& path, const std::string& text) {
        fs::create_directories(fs::path(path).parent_path());
        ASSERT_TRUE(write_text(path, text).ok()) << path;
    }
    static std::string text_of(const std::string& path) {
        std::string text;
        EXPECT_TRUE(read_text(path, text).ok()) << path;
        return text;
    }

    TemporaryDirectory directory_;
};

Job tiles() {
    Job job;
    job.program = "graftal 1 abc";
    job.kind = JobKind::tiles;
    job.words = {"render", "a b.inst", "--size", "100x70"};
    job.result = "a b.png";
    job.files = {{"a b.inst", "123"}, {"pictures/bark.png", "456"}};
    job.tasks = 12;
    job.tile = {30, 25};
    // Numbers that need all their digits.
    job.fit = PictureFit{.size = {100, 70},
                         .error_px = 0.5 / 3,
                         .error_world = 1e-7 / 3,
                         .most_visits = 131072,
                         .sampling = {.block = 1, .antialias = 3, .most_samples = 7, .noise_255 = 0.1},
                         .seconds = 12.5};
    return job;
}

TEST_F(JobFiles, ManifestsReadBackAsTheyWere) {
    Job job = tiles();
    ASSERT_TRUE(folder().write(job).ok());
    Job read;
    ASSERT_TRUE(folder().read(read).ok());
    EXPECT_EQ(read.words, job.words);
    EXPECT_EQ(read.files, job.files);
    EXPECT_EQ(read.fit, job.fit);
    EXPECT_EQ(read.tile, job.tile);
    EXPECT_EQ(read.program, job.program);

    job.kind = JobKind::sweep;
    job.fit.reset();
    job.axes = {*parse_sweep_axis("k=0..1 by 0.5"), *parse_sweep_axis("seed=1..4")};
    ASSERT_TRUE(folder().write(job).ok());
    ASSERT_TRUE(folder().read(read).ok());
    EXPECT_EQ(read.axes, job.axes);
}

TEST_F(JobFiles, ManifestsThatAreNoneAreRefused) {
    Job job = tiles(), read;
    EXPECT_THAT(folder().read(read).message(), HasSubstr("holds no job"));
    ASSERT_TRUE(folder().write(job).ok());
    const std::string whole = text_of(folder().manifest());
    write(folder().manifest(), whole.substr(0, whole.size() / 2));
    EXPECT_THAT(folder().read(read).message(), HasSubstr("is damaged"));
    write(folder().manifest(), "{\"format\": 999}");
    EXPECT_THAT(folder().read(read).message(), HasSubstr("another version"));
    const auto contradicts = [&](const auto& spoil) {
        job = tiles();
        spoil(job);
        EXPECT_TRUE(folder().write(job).ok());
        EXPECT_THAT(folder().read(read).message(), HasSubstr("contradicts itself"));
    };
    contradicts([](Job& j) { j.tasks = 13; });
    contradicts([](Job& j) { j.tasks = 0; });
    contradicts([](Job& j) { j.tile = {0, 25}; });
    contradicts([](Job& j) { j.fit.reset(); });
    contradicts([](Job& j) { j.fit->sampling.block = 0; });
    contradicts([](Job& j) { j.fit->sampling.antialias = 40; });
    contradicts([](Job& j) { j.kind = JobKind::frames; });
    contradicts([](Job& j) { j.words = {"render"}; });
}

TEST_F(JobFiles, TilesCoverEveryPixelOnce) {
    const Job job = tiles();
    std::vector<int> covered(100 * 70);
    for (std::uint64_t task = 1; task <= job.tasks; ++task) {
        const Tile tile = job.tile_of(task);
        ASSERT_TRUE(tile.lies_in({100, 70})) << task;
        for (int y = tile.y; y < tile.y + tile.height; ++y)
            for (int x = tile.x; x < tile.x + tile.width; ++x)
                ++covered[static_cast<std::size_t>(y * 100 + x)];
    }
    EXPECT_EQ(covered, std::vector<int>(covered.size(), 1));
}

TEST_F(JobFiles, AModelIsCopiedWithWhatItUsesAndChangesAreSeen) {
    const std::string home = directory_.path() + "/home";
    write(home + "/trees/oak.inst", "oak");
    write(home + "/leaves/leaf.inst", "leaf");
    write(home + "/bark.png", "bark");
    ModelCopy copy;
    // As a model in trees/ names them.
    ASSERT_TRUE(copy_model(home + "/trees/oak.inst",
                           {home + "/trees/../leaves/leaf.inst", home + "/trees/../bark.png",
                            home + "/trees/oak.inst"},
                           folder().model_folder(), copy)
                    .ok());
    EXPECT_EQ(copy.model, "trees/oak.inst");
    ASSERT_EQ(copy.files.size(), 3u);
    EXPECT_EQ(text_of(folder().model_folder() + "/leaves/leaf.inst"), "leaf");
    EXPECT_TRUE(check_files(folder().model_folder(), copy.files).ok());
    write(folder().model_folder() + "/leaves/leaf.inst", "Leaf");
    EXPECT_THAT(check_files(folder().model_folder(), copy.files).message(), HasSubstr("leaves/leaf.inst"));
    fs::remove(folder().model_folder() + "/leaves/leaf.inst");
    EXPECT_FALSE(check_files(folder().model_folder(), copy.files).ok());
    EXPECT_FALSE(copy_model(home + "/trees/none.inst", {}, folder().model_folder(), copy).ok());
}

TEST_F(JobFiles, ATaskIsDoneIfItsRecordAndItsPartAgree) {
    const Job job = tiles();
    EXPECT_FALSE(is_done(folder(), job, 3));
    write(folder().part(job, 3), "pixels");
    EXPECT_FALSE(is_done(folder(), job, 3));
    TaskRecord record{.done = true,
                      .seconds = 2,
                      .draw_seconds = 1.5,
                      .bytes = 6,
                      .digest = file_digest(folder().part(job, 3)),
                      .ended = 100};
    note_start(folder(), 3);
    note_start(folder(), 3);
    ASSERT_TRUE(write_record(folder(), 3, record).ok());
    EXPECT_TRUE(is_done(folder(), job, 3));
    EXPECT_EQ(missing_tasks(folder(), job).size(), 11u);

    note_start(folder(), 5);
    note_start(folder(), 7);
    ASSERT_TRUE(write_record(folder(), 7, {.message = "no \"room\" \xff"}).ok());
    const JobStatus status = look_at_job(folder(), job);
    EXPECT_EQ(status.done, 1u);
    EXPECT_EQ(status.begun, 1u);
    EXPECT_EQ(status.runs, 4u);
    EXPECT_EQ(status.slowest_task, 3u);
    EXPECT_DOUBLE_EQ(status.share_beside_pixels, 0.25);
    ASSERT_EQ(status.failures.size(), 1u);
    EXPECT_EQ(status.failures[0].task, 7u);
    EXPECT_THAT(status.failures[0].message, HasSubstr("no \"room\""));
    const std::string text = status_text(folder(), job, status);
    EXPECT_THAT(text, HasSubstr("1 of 12 tasks done, 1 begun, 1 failed"));
    EXPECT_THAT(text, HasSubstr("runs: 4, 2 of them ended without a result")) << "one is at work";

    write(folder().part(job, 3), "Pixels"); // as long, and another
    EXPECT_FALSE(is_done(folder(), job, 3));
    write(folder().record(3), "{\"state\":");
    EXPECT_FALSE(is_done(folder(), job, 3));
}

TEST_F(JobFiles, StatisticsThatAreNoObjectAreLeftOut) {
    write(folder().record(2), R"({"state": "done", "host": "h", "seconds": 1, "draw_seconds": 1,
        "processor_seconds": 1, "peak_bytes": 1, "ended": 1, "stats": 5})");
    const std::optional<TaskRecord> record = read_record(folder(), 2);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->stats, "");
}

TEST_F(JobFiles, ThePaceIsThatOfTheLastEnds) {
    const Job job = tiles();
    for (const std::uint64_t task : {1, 2, 3}) {
        write(folder().part(job, task), "pixels");
        ASSERT_TRUE(write_record(folder(), task,
                                 {.done = true, .bytes = 6, .ended = 10.0 * static_cast<double>(task)})
                        .ok());
    }
    const JobStatus status = look_at_job(folder(), job);
    ASSERT_TRUE(status.tasks_a_second && status.seconds_left);
    EXPECT_DOUBLE_EQ(*status.tasks_a_second, 0.1);
    EXPECT_DOUBLE_EQ(*status.seconds_left, 90);
}

TEST(TaskLists, AreAsSlurmHasThem) {
    EXPECT_EQ(task_list_text({1, 2, 3, 7, 9, 10}), "1-3,7,9-10");
    EXPECT_THAT(*parse_task_list("1-3,7,9-10", 10), ElementsAre(1, 2, 3, 7, 9, 10));
    for (const char* text : {"", "0", "11", "3-2", "1-11", "1,,2", "a", "1-", "-1", "2,1", "1-3,3", "1 "})
        EXPECT_FALSE(parse_task_list(text, 10)) << text;
}

TEST(Slurm, GroupsHoldEachTaskOnceInOrder) {
    std::vector<std::uint64_t> tasks;
    for (std::uint64_t i = 1; i <= 2500; ++i)
        tasks.push_back(i);
    for (const std::uint64_t size : {1, 3, 100, 5000}) {
        const auto groups = group_tasks(tasks, 1000, size);
        std::vector<std::uint64_t> all;
        for (const auto& group : groups)
            all.insert(all.end(), group.begin(), group.end());
        EXPECT_EQ(all, tasks);
        EXPECT_LE(groups.size(), 1000u);
    }
    EXPECT_EQ(group_tasks(tasks, 1000, 5000).size(), 1u);
    EXPECT_EQ(group_tasks(tasks, 1000, 100).size(), 25u);
    EXPECT_EQ(group_tasks(tasks, 1000, 1).size(), 1000u);
    EXPECT_TRUE(group_tasks({}, 1000, 1).empty());
    EXPECT_EQ(minute_of_tasks(0.6), 100u);
    EXPECT_EQ(minute_of_tasks(600), 1u);
    EXPECT_EQ(minute_of_tasks(0), 60'000u);
    EXPECT_EQ(minutes_for(10, 60), 110u);
}

TEST(Slurm, ItsAnswersAreRead) {
    EXPECT_EQ(parse_job_id("1234\n"), "1234");
    EXPECT_EQ(parse_job_id("1234;cluster\n"), "1234");
    EXPECT_EQ(parse_job_id("sbatch: error\n"), "");
    EXPECT_THAT(parse_indices("3\n17\n"), ElementsAre(3, 17));
    EXPECT_TRUE(parse_indices("slurm_load_jobs error: Invalid job id specified\n").empty());
    EXPECT_EQ(parse_array_size("A = 1\nMaxArraySize            = 10001\nB = 2\n"), 10000u);
    EXPECT_EQ(parse_array_size(""), usual_array_size);
}

TEST_F(JobFiles, ArraysOfSlurmReadBackAsTheyWere) {
    fs::create_directories(slurm_folder(folder()));
    EXPECT_TRUE(read_arrays(folder()).empty());
    ASSERT_TRUE(write_arrays(folder(), {{"7", "8", {{1, 2, 3}, {9}}}, {"12", "", {{4}}}}).ok());
    const std::vector<SlurmArray> arrays = read_arrays(folder());
    ASSERT_EQ(arrays.size(), 2u);
    EXPECT_EQ(arrays[0].merge_id, "8");
    EXPECT_THAT(arrays[0].groups, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(9)));
}

} // namespace
} // namespace graftal
