#include "runtime/farm/sweep_axes.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "runtime/farm/job.h"

namespace graftal {

namespace {

std::optional<double> number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

bool is_name(std::string_view text) {
    if (text.empty()) return false;
    for (const char c : text)
        if (!(c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')))
            return false;
    return !(text.front() >= '0' && text.front() <= '9');
}

/// A number of a range in the digits that people write: 0.1 + 0.2 is 0.3. `step`: of the range.
std::string short_text(double value, double step) {
    constexpr double least = 1e-9; // share of a step, of sums that are meant to be 0
    if (value == std::round(value) && std::abs(value) < 1e15) return fmt::format("{:.0f}", value);
    return fmt::format("{:.12g}", std::abs(value) < least * step ? 0.0 : value);
}

bool add_range(std::string_view from_text, std::string_view rest, std::vector<std::string>& values) {
    constexpr std::string_view by = " by ";
    const std::size_t at = rest.find(by);
    const auto from = number(from_text), to = number(rest.substr(0, at));
    const auto step = at == std::string_view::npos ? std::optional(1.0) : number(rest.substr(at + by.size()));
    if (!from || !to || !step || !(*step > 0)) return false;
    constexpr double slack = 1e-9; // of a step: 0..1 by 0.1 has its 1
    const double steps = std::floor(std::abs(*to - *from) / *step + slack);
    if (!(steps < static_cast<double>(most_tasks))) return false;
    for (double i = 0; i <= steps; ++i)
        values.push_back(short_text(*from + (*to < *from ? -i : i) * *step, *step));
    return true;
}

bool add_list(std::string_view text, std::vector<std::string>& values) {
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view value = text.substr(0, comma);
        if (!number(value) || values.size() == most_tasks) return false;
        values.emplace_back(value);
        if (comma == std::string_view::npos) return true;
        text.remove_prefix(comma + 1);
    }
}

} // namespace

std::vector<std::string> SweepAxis::words(const std::string& value) const {
    if (name == "seed" || name == "steps") return {"--" + name, value};
    return {"--set", name + "=" + value};
}

std::optional<SweepAxis> parse_sweep_axis(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || !is_name(text.substr(0, equals))) return std::nullopt;
    SweepAxis axis{std::string(text.substr(0, equals)), {}};
    const std::string_view values = text.substr(equals + 1);
    const std::size_t dots = values.find("..");
    const bool well = dots == std::string_view::npos
                          ? add_list(values, axis.values)
                          : add_range(values.substr(0, dots), values.substr(dots + 2), axis.values);
    return well ? std::optional(std::move(axis)) : std::nullopt;
}

std::uint64_t point_count(const std::vector<SweepAxis>& axes) {
    std::uint64_t count = 1;
    for (const SweepAxis& axis : axes)
        count = count > most_tasks ? count : count * axis.values.size();
    return count;
}

std::vector<std::string> values_at(const std::vector<SweepAxis>& axes, std::uint64_t point) {
    std::vector<std::string> values(axes.size());
    for (std::size_t i = axes.size(); i-- > 0; point /= axes[i].values.size())
        values[i] = axes[i].values[point % axes[i].values.size()];
    return values;
}

std::string label_at(const std::vector<SweepAxis>& axes, std::uint64_t point) {
    const std::vector<std::string> values = values_at(axes, point);
    std::string label;
    for (std::size_t i = 0; i < axes.size(); ++i)
        label += (i == 0 ? "" : " ") + axes[i].name + "=" + values[i];
    return label;
}

std::uint64_t column_count(const std::vector<SweepAxis>& axes) {
    if (axes.size() > 1) return axes.back().values.size();
    return static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(point_count(axes)))));
}

} // namespace graftal
