#include "runtime/farm/slurm.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "runtime/farm/job_json.h"
#include "runtime/farm/task_records.h"

namespace graftal {

namespace {

using Json = JobJson;

constexpr std::uint64_t most_arrays_bytes = 16u << 20;
/// In all groups of all arrays.
constexpr std::size_t most_listed = 10 * most_tasks, most_arrays = 1000;

std::string arrays_file(const JobFolder& folder) {
    return slurm_folder(folder) + "/arrays.json";
}

} // namespace

std::uint64_t minute_of_tasks(double task_seconds) {
    constexpr double minute = 60;
    return static_cast<std::uint64_t>(
        std::clamp(minute / std::max(task_seconds, 1e-3), 1.0, static_cast<double>(most_tasks)));
}

std::vector<std::vector<std::uint64_t>> group_tasks(const std::vector<std::uint64_t>& tasks,
                                                    std::uint64_t most_groups, std::uint64_t group) {
    std::vector<std::vector<std::uint64_t>> groups;
    const std::uint64_t wanted = std::min((tasks.size() + group - 1) / group, most_groups);
    for (std::uint64_t i = 0; i < wanted; ++i) {
        const auto first = static_cast<std::ptrdiff_t>(i * tasks.size() / wanted);
        const auto end = static_cast<std::ptrdiff_t>((i + 1) * tasks.size() / wanted);
        groups.emplace_back(tasks.begin() + first, tasks.begin() + end);
    }
    return groups;
}

std::uint64_t minutes_for(std::uint64_t tasks, double task_seconds) {
    constexpr double times = 10, more = 10, most = 365 * 24 * 60;
    return static_cast<std::uint64_t>(
        std::ceil(std::min(most, more + times * static_cast<double>(tasks) * task_seconds / 60)));
}

std::string slurm_folder(const JobFolder& folder) {
    return folder.path() + "/slurm";
}

std::vector<SlurmArray> read_arrays(const JobFolder& folder) {
    std::string text;
    std::vector<SlurmArray> arrays;
    if (!folder.read_file(arrays_file(folder), text, most_arrays_bytes).ok()) return arrays;
    std::size_t listed = 0;
    bool well = true;
    const std::string problem = read_job_json(text, [&](const Json& all) {
        for (const Json& json : all) {
            SlurmArray array{json.at("id"), json.at("merge"), {}};
            well = well && parse_job_id(array.id) == array.id && !array.id.empty();
            for (const Json& group : json.at("groups")) {
                if (!well || listed > most_listed) break;
                array.groups.push_back(parse_task_list(group.get<std::string>(), most_tasks)
                                           .value_or(std::vector<std::uint64_t>()));
                listed += array.groups.back().size();
            }
            arrays.push_back(std::move(array));
        }
    });
    if (!problem.empty() || !well || listed > most_listed || arrays.size() > most_arrays) arrays.clear();
    return arrays;
}

Status write_arrays(const JobFolder& folder, const std::vector<SlurmArray>& arrays) {
    Json json = Json::array();
    for (const SlurmArray& array : arrays) {
        Json groups = Json::array();
        for (const std::vector<std::uint64_t>& group : array.groups)
            groups.push_back(task_list_text(group));
        json.push_back({{"id", array.id}, {"merge", array.merge_id}, {"groups", groups}});
    }
    return folder.write_file(arrays_file(folder), json.dump(1) + "\n");
}

Status write_array_script(const JobFolder& folder, std::size_t number,
                          const std::vector<std::vector<std::uint64_t>>& groups, const std::string& command,
                          std::string& script) {
    std::error_code error;
    std::filesystem::create_directories(slurm_folder(folder), error);
    std::string lines;
    for (const std::vector<std::uint64_t>& group : groups)
        lines += task_list_text(group) + "\n";
    if (Status status =
            folder.write_file(fmt::format("{}/groups_{}.txt", slurm_folder(folder), number), lines);
        !status.ok())
        return status;
    script = fmt::format("{}/array_{}.sh", slurm_folder(folder), number);
    return folder.write_file(
        script, fmt::format("#!/bin/sh\n"
                            "# One group of tasks: the line of groups_{}.txt with the array's index.\n"
                            "tasks=$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" \"$1\") || exit 3\n"
                            "exec {} \"$tasks\" --quiet --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
                            number, command));
}

std::string parse_job_id(const std::string& printed) {
    const std::string id = printed.substr(0, printed.find_first_of(";\n"));
    return parse_whole<std::uint64_t>(id) ? id : "";
}

std::set<std::uint64_t> parse_indices(const std::string& printed) {
    std::set<std::uint64_t> indices;
    std::istringstream words(printed);
    for (std::string word; words >> word;)
        if (const auto index = parse_whole<std::uint64_t>(word)) indices.insert(*index);
    return indices;
}

std::uint64_t parse_array_size(const std::string& printed) {
    const std::size_t at = printed.find("MaxArraySize");
    if (at == std::string::npos) return usual_array_size;
    std::istringstream words(printed.substr(at));
    std::string word;
    words >> word >> word >> word; // MaxArraySize = 1001
    const auto size = parse_whole<std::uint64_t>(word);
    return size && *size > 1 ? *size - 1 : usual_array_size;
}

} // namespace graftal
