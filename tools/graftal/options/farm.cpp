#include "tools/graftal/options/farm.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "runtime/farm/join_tiles.h"
#include "tools/graftal/options.h"
#include "tools/graftal/options/shared.h"
#include "tools/graftal/options/values.h"

namespace graftal {

namespace {

/// Options of `farm plan` itself, each with a value.
constexpr std::array<std::string_view, 5> plan_options = {"-o", "--output", "--tiles", "--sweep", "--result"};

CLI::App& add_action(CLI::App& farm, Options& options, FarmAction action, const std::string& name,
                     const std::string& summary) {
    CLI::App* const app = farm.add_subcommand(name, summary);
    app->callback([&options, action] { options.farm.action = action; });
    if (action != FarmAction::plan)
        app->add_option("JOB", options.farm.folder, "Folder of the job, that 'farm plan' has made")
            ->required()
            ->type_name("");
    return *app;
}

void add_quiet(CLI::App& app, Options& options) {
    app.add_flag("-q,--quiet", options.quiet, "Print only errors and warnings, no progress and no summary");
}

void add_plan(CLI::App& farm, Options& options) {
    FarmOptions& own = options.farm;
    CLI::App& app = add_action(farm, options, FarmAction::plan, "plan",
                               "Make the folder of a job: what is to be drawn, in tasks");
    app.add_option("MODEL", options.operands, model_file_help())->type_name("");
    app.add_option("-o,--output", own.folder, "Folder of the job to make")->required()->type_name("JOB");
    add_value(app, "--tiles", "WxH", "Draw one picture in tiles of this size", "a size such as 512x512",
              parse_size, [&own](ImageSize size) { own.tile = size; });
    app.add_option_function<std::vector<std::string>>(
           "--sweep",
           [&own](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) {
                   const auto axis = parse_sweep_axis(text);
                   if (!axis)
                       throw CLI::ValidationError(fmt::format(
                           "--sweep: '{}' is not of the form NAME=A..B, \"NAME=A..B by STEP\" or NAME=A,B,C",
                           text));
                   own.sweeps.push_back(*axis);
               }
           },
           "Draw a picture for each of these values: of seed, steps or a 'let'; given twice or more, for "
           "each combination")
        ->allow_extra_args(false)
        ->type_name("NAME=VALUES");
    app.add_flag("--coarse", own.coarse,
                 "With --tiles: plan a picture even where its work leaves out parts of more than 2 pixels");
    app.add_option("--result", own.result,
                   "File that 'farm merge' makes (default: MODEL's name + .png or .gif, in JOB)")
        ->type_name("FILE");
    app.footer(
        "One of three things is planned:\n"
        "  --tiles WxH      one picture, by all options of 'graftal render'; up to 131072 pixels a side;\n"
        "                   --work is for each million pixels of a large one\n"
        "  --frames N       an animation, by all options of 'graftal animate'\n"
        "  --sweep VALUES   many pictures, by all options of 'graftal render'; the merge makes a contact\n"
        "                   sheet of them, and a table (.csv) with the 'stats' of each model\n"
        "graftal draws with '--engine native' unless you name another. JOB gets copies of the model and of\n"
        "all files that it uses, and JOB/commands.txt one command a line: run each line anywhere, in any\n"
        "order, as often as you like ('farm submit', GNU parallel, xargs or OpenCue can). The result has "
        "the\n"
        "very bytes that one run of 'graftal render' or 'graftal animate' with these options writes.\n"
        "Examples:\n"
        "  graftal farm plan elm.inst --tiles 1000x300 --size 40000x30000 --work 60 -o poster/\n"
        "  graftal farm plan plant.lsys --frames 3000 --steps 1..12 --result growth.mp4 -o film/\n"
        "  graftal farm plan plant.lsys --sweep seed=1..10000 --size 160x160 -o seeds/\n"
        "  graftal farm plan tree.inst --sweep \"k=0..1 by 0.1\" --sweep a=10,20,30 -o grid/");
}

void add_submit(CLI::App& farm, Options& options) {
    FarmOptions& own = options.farm;
    CLI::App& app =
        add_action(farm, options, FarmAction::submit, "submit", "Run the tasks of a job that are missing");
    add_value(
        app, "--local", "N", "Run N tasks at a time on this machine, until all are done",
        "a whole number from 1 to 512", [](const std::string& text) { return parse_whole(text, 1, 512); },
        [&own](std::uint64_t count) { own.local = static_cast<int>(count); });
    app.add_flag("--slurm", own.slurm, "Submit them to Slurm, as one array job, and the merge after it");
    app.add_flag("--resume", own.resume,
                 "With --slurm: submit again what is neither done nor still waiting or at work");
    add_value(
        app, "--at-once", "N", "With --slurm: at most so many at a time (default: Slurm decides)",
        "a whole number from 1 to 100000",
        [](const std::string& text) { return parse_whole(text, 1, 100'000); },
        [&own](std::uint64_t count) { own.at_once = static_cast<int>(count); });
    add_value(
        app, "--test-group", "N",
        "With --slurm: so many tasks in each index of the array (default: a minute's worth by the estimate)",
        "a whole number from 1 to 100000",
        [](const std::string& text) { return parse_whole(text, 1, 100'000); },
        [&own](std::uint64_t count) { own.group = count; });
    add_quiet(app, options);
    app.footer("Tasks that are done are never run again, so the same command goes on after anything.\n"
               "Slurm is asked for one processor a task, and for time and memory by the plan's estimate.\n"
               "What follows '--' are options for sbatch, which win.\n"
               "Examples:\n"
               "  graftal farm submit poster/ --local 8 && graftal farm merge poster/\n"
               "  graftal farm submit film/ --slurm --at-once 200 -- --partition=short --account=botany\n"
               "  graftal farm submit film/ --slurm --resume\n"
               "  parallel < film/commands.txt");
}

void add_status(CLI::App& farm, Options& options) {
    CLI::App& app =
        add_action(farm, options, FarmAction::status, "status", "Print how far a job is, and what failed");
    app.add_flag("--json", options.json, "Print one JSON object on standard output");
    app.footer("The exit status is 0 if all tasks are done, 1 if any failed, and 3 if there is no job.\n"
               "Example:\n  watch graftal farm status film/");
}

void add_merge(CLI::App& farm, Options& options) {
    CLI::App& app =
        add_action(farm, options, FarmAction::merge, "merge",
                   "Join tiles to a picture, frames to a film, or a sweep to a sheet and a table");
    add_quiet(app, options);
    app.footer("graftal holds one row of tiles in memory, whatever the size of the picture.\n"
               "Example:\n  graftal farm merge poster/");
}

void add_clean(CLI::App& farm, Options& options) {
    CLI::App& app = add_action(farm, options, FarmAction::clean, "clean",
                               "Remove a job's tasks and their parts, and leave the result");
    app.add_flag("--all", options.farm.everything, "Do so before there is a result, too");
    add_quiet(app, options);
    app.footer("Example:\n  graftal farm clean poster/");
}

void add_task(CLI::App& farm, Options& options) {
    CLI::App& app = add_action(farm, options, FarmAction::task, "task",
                               "Run tasks of a job, those that are not done: what JOB/commands.txt says");
    app.add_option("TASKS", options.farm.tasks, "Numbers of tasks, such as 7 or 1-3,7")
        ->required()
        ->type_name("");
    add_value(
        app, "--threads", "N", "Number of threads (default: one per processor)",
        "a whole number from 1 to 512", [](const std::string& text) { return parse_whole(text, 1, 512); },
        [&](std::uint64_t threads) { options.render.threads = static_cast<int>(threads); });
    add_quiet(app, options);
    app.footer(
        "A task can be killed, run twice, or run by two machines at once: its picture appears whole or\n"
        "not at all, and graftal reads it again before it counts as done. graftal refuses a job of\n"
        "another build of graftal, and one whose model has changed.\n"
        "Example:\n  graftal farm task poster/ 1-10 --threads 1");
}

bool is_own(const std::string& word) {
    return std::find(plan_options.begin(), plan_options.end(), word) != plan_options.end();
}

/// "--tiles=9x9"
bool is_own_with_value(const std::string& word) {
    return std::any_of(plan_options.begin(), plan_options.end(), [&](std::string_view option) {
        return option.starts_with("--") && word.starts_with(std::string(option) + "=");
    });
}

std::string refusal_of_plan(const FarmOptions& own) {
    const bool frames = std::any_of(own.words.begin(), own.words.end(), [](const std::string& word) {
        return word == "--frames" || word.starts_with("--frames=");
    });
    if ((own.tile ? 1 : 0) + (own.sweeps.empty() ? 0 : 1) + (frames ? 1 : 0) != 1)
        return "give one of --tiles WxH, --frames N and --sweep NAME=VALUES";
    if (own.words.empty()) return "no model given: try 'graftal farm plan MODEL'";
    if (point_count(own.sweeps) > most_tasks)
        return fmt::format("--sweep: these are more than {} pictures", most_tasks);
    for (std::size_t i = 0; i < own.sweeps.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (own.sweeps[i].name == own.sweeps[j].name)
                return fmt::format("--sweep: '{}' is given twice", own.sweeps[i].name);
    return {};
}

} // namespace

void add_farm(CLI::App& app, Options& options) {
    add_plan(app, options);
    add_submit(app, options);
    add_status(app, options);
    add_merge(app, options);
    add_clean(app, options);
    add_task(app, options);
    app.footer(
        "'plan' makes the folder of a job, 'submit' runs its tasks here or by Slurm, 'status' says how\n"
        "far they are, 'merge' makes the result, 'clean' removes the rest. 'graftal farm COMMAND --help'\n"
        "explains each; docs/farm.md tells the whole story.\n"
        "Example:\n"
        "  graftal farm plan elm.inst --tiles 512x512 --size 8192x8192 -o poster/\n"
        "  graftal farm submit poster/ --local 4\n"
        "  graftal farm merge poster/                            # makes poster/elm.png");
}

std::vector<std::string> take_foreign_words(std::vector<std::string>& words) {
    std::vector<std::string> planned;
    if (words.size() < 3 || words[1] != "farm") return planned;
    if (words[2] == "submit") {
        const auto mark = std::find(words.begin(), words.end(), "--");
        if (mark == words.end()) return planned;
        planned.assign(mark + 1, words.end());
        words.erase(mark, words.end());
    }
    if (words[2] != "plan") return planned;
    std::vector<std::string> own(words.begin(), words.begin() + 3);
    for (std::size_t i = 3; i < words.size(); ++i) {
        if (words[i] == "--help" || words[i] == "-h" || words[i] == "--coarse" ||
            is_own_with_value(words[i])) {
            own.push_back(words[i]);
        } else if (is_own(words[i])) {
            own.push_back(words[i]);
            if (i + 1 < words.size()) own.push_back(words[++i]);
        } else {
            planned.push_back(words[i]);
        }
    }
    words = std::move(own);
    return planned;
}

std::string complete_farm(Options& options) {
    const FarmOptions& own = options.farm;
    if (own.folder.empty()) return "JOB: name a folder";
    if (own.action == FarmAction::plan) return refusal_of_plan(own);
    if (own.action != FarmAction::submit) return {};
    if (own.local.has_value() == own.slurm) return "give one of --local N and --slurm";
    if (own.local && (own.resume || own.at_once > 0 || own.group > 0 || !own.words.empty()))
        return "--resume, --at-once and options for sbatch go with --slurm";
    return {};
}

} // namespace graftal
