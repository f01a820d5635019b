#include "runtime/studio/address_text.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace graftal {

namespace {

bool is_plain(const std::string& name) {
    return !name.empty() && !std::isdigit(static_cast<unsigned char>(name.front())) &&
           std::ranges::all_of(
               name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

std::string text_of(const Graph& graph, const GraphStep& step) {
    const std::vector<Instance>& instances = graph.objects[step.object].instances;
    const ObjectId master = instances[step.instance].master;
    const std::string& name = graph.objects[master].name;
    if (name.find('"') != std::string::npos) return fmt::format("#{}", step.instance + 1);
    const std::string word = is_plain(name) ? name : '"' + name + '"';
    std::uint32_t alike = 0, index = 0;
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (instances[i].master != master) continue;
        ++alike;
        if (i <= step.instance) index = alike;
    }
    return alike == 1 ? word : fmt::format("{}#{}", word, index);
}

/// Times that the steps from `begin` on, `period` of them, come one after the other.
std::size_t repeats(const std::vector<std::string>& steps, std::size_t begin, std::size_t period) {
    std::size_t end = begin + period;
    while (end < steps.size() && steps[end] == steps[end - period])
        ++end;
    return (end - begin) / period;
}

} // namespace

std::string address_of(const Graph& graph, const std::vector<GraphStep>& path) {
    constexpr std::size_t longest_period = 6, least_saved = 3; // steps
    std::vector<std::string> steps;
    for (const GraphStep& step : path)
        steps.push_back(text_of(graph, step));
    std::string text;
    for (std::size_t i = 0; i < steps.size();) {
        std::size_t period = 1, count = 1;
        for (std::size_t p = 1; p <= longest_period && i + p <= steps.size(); ++p)
            if (const std::size_t times = repeats(steps, i, p); (times - 1) * p > (count - 1) * period)
                period = p, count = times;
        if ((count - 1) * period < least_saved) period = count = 1;
        std::string part = steps[i];
        for (std::size_t k = 1; k < period; ++k)
            part += "." + steps[i + k];
        if (period > 1) part = "(" + part + ")";
        if (count > 1) part += fmt::format("*{}", count);
        if (!text.empty()) text += '.';
        text += part;
        i += period * count;
    }
    return text;
}

} // namespace graftal
