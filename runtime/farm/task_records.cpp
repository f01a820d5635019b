#include "runtime/farm/task_records.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/support/number.h"
#include "runtime/farm/job_json.h"
#include "runtime/system/files_below.h"

namespace graftal {

namespace {

using Json = JobJson;

constexpr std::uint64_t most_record_bytes = 256u << 10, most_starts_bytes = 1u << 20;

std::string host_name() {
    char name[256] = "";
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

} // namespace

bool has_part(const JobFolder& folder, const Job& job, std::uint64_t task, const TaskRecord& record) {
    const std::string path = folder.part(job, task);
    return bytes_below(folder.path(), folder.name_of(path)) == record.bytes;
}

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

Status write_record(const JobFolder& folder, std::uint64_t task, const TaskRecord& record) {
    Json json = {{"state", record.done ? "done" : "failed"}};
    if (!record.done) json["message"] = record.message;
    json["host"] = host_name();
    json["seconds"] = record.seconds;
    json["draw_seconds"] = record.draw_seconds;
    json["processor_seconds"] = record.processor_seconds;
    json["peak_bytes"] = record.peak_bytes;
    if (record.done) {
        json["bytes"] = record.bytes;
        json["digest"] = record.digest;
    }
    json["ended"] = record.ended;
    if (!record.stats.empty()) json["stats"] = Json::parse(record.stats);
    // Words of a model or of the system need not be UTF-8.
    return folder.write_file(folder.record(task),
                             json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<TaskRecord> read_record(const JobFolder& folder, std::uint64_t task) {
    std::string text;
    if (!folder.read_file(folder.record(task), text, most_record_bytes).ok()) return std::nullopt;
    TaskRecord record;
    const std::string problem = read_job_json(text, [&](const Json& json) {
        record.done = json.at("state") == "done";
        record.message = json.value("message", "");
        record.host = json.at("host");
        record.seconds = amount_of_json(json.at("seconds"));
        record.draw_seconds = amount_of_json(json.at("draw_seconds"));
        record.processor_seconds = amount_of_json(json.at("processor_seconds"));
        record.peak_bytes = whole_of_json(json.at("peak_bytes"));
        if (json.contains("bytes")) record.bytes = whole_of_json(json["bytes"]);
        record.digest = json.value("digest", "");
        record.ended = amount_of_json(json.at("ended"));
        if (json.contains("stats") && json["stats"].is_object()) record.stats = json["stats"].dump();
    });
    return problem.empty() ? std::optional(record) : std::nullopt;
}

bool is_done(const JobFolder& folder, const Job& job, std::uint64_t task) {
    const std::optional<TaskRecord> record = read_record(folder, task);
    return record && record->done && !record->digest.empty() && has_part(folder, job, task, *record) &&
           folder.digest(folder.part(job, task), job.most_part_bytes()) == record->digest;
}

void note_start(const JobFolder& folder, std::uint64_t task) {
    const std::string path = folder.starts(task);
    const int file = open_below(folder.path(), folder.name_of(path), O_WRONLY | O_CREAT | O_APPEND);
    if (file < 0) return;
    const std::string line = fmt::format("{:.3f} {} {}\n", now_seconds(), host_name(), ::getpid());
    if (::write(file, line.data(), line.size()) < 0) {
        // Then a report counts one start less.
    }
    ::close(file);
}

std::uint64_t count_starts(const JobFolder& folder, std::uint64_t task) {
    std::string text;
    if (!folder.read_file(folder.starts(task), text, most_starts_bytes).ok()) return 0;
    return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

std::vector<std::uint64_t> missing_tasks(const JobFolder& folder, const Job& job) {
    std::vector<std::uint64_t> missing;
    for (std::uint64_t task = 1; task <= job.tasks; ++task) {
        const std::optional<TaskRecord> record = read_record(folder, task);
        if (!record || !record->done || !has_part(folder, job, task, *record)) missing.push_back(task);
    }
    return missing;
}

std::string task_list_text(const std::vector<std::uint64_t>& tasks) {
    std::string text;
    for (std::size_t i = 0; i < tasks.size();) {
        std::size_t last = i;
        while (last + 1 < tasks.size() && tasks[last + 1] == tasks[last] + 1)
            ++last;
        text += fmt::format("{}{}", text.empty() ? "" : ",", tasks[i]);
        if (last > i) text += fmt::format("-{}", tasks[last]);
        i = last + 1;
    }
    return text;
}

std::optional<std::vector<std::uint64_t>> parse_task_list(std::string_view text, std::uint64_t most) {
    std::vector<std::uint64_t> tasks;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view range = text.substr(0, comma);
        const std::size_t dash = range.find('-');
        const auto from = parse_whole<std::uint64_t>(range.substr(0, dash));
        const auto to =
            dash == std::string_view::npos ? from : parse_whole<std::uint64_t>(range.substr(dash + 1));
        if (!from || !to || *from < 1 || *to < *from || *to > most) return std::nullopt;
        if (!tasks.empty() && *from <= tasks.back()) return std::nullopt;
        for (std::uint64_t task = *from; task <= *to; ++task)
            tasks.push_back(task);
        if (comma == std::string_view::npos) return tasks;
        text.remove_prefix(comma + 1);
    }
}

} // namespace graftal
