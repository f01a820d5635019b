#include "runtime/farm/sweep_table.h"

#include <filesystem>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "runtime/farm/job_json.h"
#include "runtime/farm/task_records.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

using Json = JobJson;

/// A cell's text with quotes by RFC 4180.
std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

std::string cell_text(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
}

/// The members of an object, and of the objects in it: "contraction.rate". Lists are left out, and the path
/// of the model, which is the same for all.
void flatten(const std::string& prefix, const Json& json,
             std::vector<std::pair<std::string, std::string>>& cells) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object())
            flatten(prefix + key + ".", value, cells);
        else if (!value.is_array() && prefix + key != "model")
            cells.emplace_back(prefix + key, cell_text(value));
    }
}

struct Row {
    std::vector<std::string> first; ///< cells that each row has
    std::map<std::string, std::string> stats;
};

std::string line(const std::vector<std::string>& cells) {
    std::string text;
    for (const std::string& cell : cells)
        text += (text.empty() ? "" : ",") + quoted(cell);
    return text + "\r\n";
}

} // namespace

Status write_sweep_table(const std::string& path, const JobFolder& folder, const Job& job) {
    std::vector<std::string> names = {"task"};
    for (const SweepAxis& axis : job.axes)
        names.push_back(axis.name);
    names.insert(names.end(), {"picture", "seconds"});
    std::vector<std::string> stats_names; // in the order in which they are met
    std::map<std::string, bool> known;
    std::vector<Row> rows;
    for (std::uint64_t task = 1; task <= job.tasks; ++task) {
        const std::optional<TaskRecord> record = read_record(folder, task);
        if (!record) return Status::failure(fmt::format("task {} has no record", task));
        Row row{{std::to_string(task)}, {}};
        for (std::string& value : values_at(job.axes, task - 1))
            row.first.push_back(std::move(value));
        row.first.push_back(std::filesystem::path(folder.part(job, task)).filename().string());
        row.first.push_back(fmt::format("{:.3f}", record->seconds));
        std::vector<std::pair<std::string, std::string>> cells;
        if (!record->stats.empty()) {
            Json stats = Json::parse(record->stats);
            stats.erase("leaves"); // the old name of primitives
            flatten("", stats, cells);
        }
        for (auto& [name, value] : cells) {
            if (known.emplace(name, true).second) stats_names.push_back(name);
            row.stats[name] = std::move(value);
        }
        rows.push_back(std::move(row));
    }
    names.insert(names.end(), stats_names.begin(), stats_names.end());
    std::string text = line(names);
    for (Row& row : rows) {
        for (const std::string& name : stats_names)
            row.first.push_back(row.stats[name]);
        text += line(row.first);
    }
    return write_text(path, text);
}

} // namespace graftal
