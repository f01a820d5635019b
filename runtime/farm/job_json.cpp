#include "runtime/farm/job_json.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr int most_levels = 64;

/// Brackets that are open at once, outside of strings.
int levels_in(std::string_view text) {
    int open = 0, most = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{'))
            most = std::max(most, ++open);
        else if (!in_string && (c == ']' || c == '}'))
            --open;
    }
    return most;
}

} // namespace

std::string read_job_json(const std::string& text, const std::function<void(const JobJson&)>& read) {
    if (levels_in(text) > most_levels) return "its values are nested too deeply";
    try {
        read(JobJson::parse(text));
        return {};
    } catch (const JobJson::exception& fault) {
        return fault.what();
    }
}

std::uint64_t whole_of_json(const JobJson& json) {
    const auto rough = json.get<double>(); // or an exception that names the type
    return json.is_number_unsigned() && rough >= 0 ? json.get<std::uint64_t>() : 0;
}

int small_whole_of_json(const JobJson& json, int most) {
    const auto value = json.get<double>();
    return value >= 0 && value <= most && json.is_number_integer() ? static_cast<int>(value) : -1;
}

double amount_of_json(const JobJson& json) {
    constexpr double most = 1e15;
    const auto value = json.get<double>();
    return value >= 0 && value <= most ? value : 0;
}

} // namespace graftal
