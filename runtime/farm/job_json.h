#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

namespace graftal {

// Numbers and texts of a job's files, whoever wrote them.

using JobJson = nlohmann::ordered_json;

/// Parses a text and gives it to `read`. Returns what is wrong with the text, or with the types that `read`
/// asks for; or "". Refuses values that are nested deeper than graftal nests any: what copies and prints them
/// takes a call for each level.
std::string read_job_json(const std::string& text, const std::function<void(const JobJson&)>& read);

/// A whole number from 0 on; 0 for one that is negative, broken or too large.
std::uint64_t whole_of_json(const JobJson& json);
/// A whole number from 0 to `most`; -1 for others.
int small_whole_of_json(const JobJson& json, int most);
/// A number from 0 to 1e15; 0 for others.
double amount_of_json(const JobJson& json);

} // namespace graftal
