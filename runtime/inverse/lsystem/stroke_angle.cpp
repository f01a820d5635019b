#include "runtime/inverse/lsystem/stroke_angle.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::int32_t most_directions = 360;
constexpr int most_turn_units = 24;
/// Sizes of turns. Multiples of one angle have far fewer.
constexpr std::size_t most_turns = 1000;
constexpr double least_angle_deg = 1;
constexpr std::size_t most_followed_angles = 100;

/// Directions, to a twentieth of a degree.
std::vector<double> distinct_degrees(const std::vector<double>& directions) {
    std::vector<double> distinct;
    distinct.reserve(directions.size());
    for (const double degrees : directions)
        distinct.push_back(std::round(degrees * 20) / 20);
    std::ranges::sort(distinct);
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    return distinct;
}

std::vector<double> angle_candidates(const std::vector<std::pair<double, std::uint64_t>>& turns,
                                     double least_deg) {
    std::vector<double> candidates = {90};
    for (const auto& turn : turns) {
        for (const double part : {1.0, 2.0, 3.0, 4.0})
            candidates.push_back(turn.first / part);
        for (const auto& other : turns)
            candidates.push_back(std::abs(turn.first - other.first));
    }
    std::erase_if(candidates, [&](double angle) { return angle < least_deg; });
    std::ranges::sort(candidates);
    const auto same = [](double a, double b) { return std::abs(a - b) < 1e-6; };
    candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
    if (candidates.size() > 400) candidates.resize(400);
    return candidates;
}

/// The angle by the mean of all turns, with as few digits as they tell.
double refined(const std::vector<double>& turns, const AngleGrid& grid, WorkMeter& meter) {
    meter.add(turns.size());
    double sum = 0, weight = 0, squares = 0;
    for (const double turn : turns) {
        const double units = std::round(turn / grid.angle_deg);
        if (std::abs(turn - units * grid.angle_deg) > 0.1 * grid.angle_deg) continue;
        sum += turn * units;
        weight += units * units;
    }
    if (weight == 0) return grid.angle_deg;
    const double mean = sum / weight;
    for (const double turn : turns)
        squares += std::pow(std::remainder(turn, mean), 2);
    const double doubt = std::max(1e-5, 3 * std::sqrt(squares) / static_cast<double>(turns.size()));
    for (int digits = 1; digits < 12; ++digits) {
        std::string text;
        append_number(text, mean, digits);
        const double rounded = parse_number(text).value_or(mean);
        if (std::abs(rounded - mean) < doubt) return rounded;
        if (digits >= 3 && grid.directions > 0 && std::abs(360.0 / grid.directions - mean) < doubt)
            return 360.0 / grid.directions;
    }
    return mean;
}

} // namespace

double wrapped_deg(double angle) {
    angle = std::fmod(angle, 360);
    return angle > 180 ? angle - 360 : angle <= -180 ? angle + 360 : angle;
}

std::vector<std::pair<double, std::uint64_t>> value_groups(std::vector<double> values, double apart) {
    std::ranges::sort(values);
    std::vector<std::pair<double, std::uint64_t>> groups;
    double last = 0;
    for (const double value : values) {
        if (groups.empty() || value - last > apart) groups.emplace_back(0, 0);
        groups.back().first += value;
        ++groups.back().second;
        last = value;
    }
    for (auto& [sum, count] : groups)
        sum /= static_cast<double>(count);
    return groups;
}

std::int32_t AngleGrid::units(double deg) const {
    if (directions > 0) {
        const auto whole = static_cast<std::int32_t>(std::llround(wrapped_deg(deg) * directions / 360));
        return 2 * whole <= -directions ? whole + directions : whole;
    }
    std::int32_t best = 0;
    for (std::int32_t k = 1; k <= most_turn_units; ++k)
        for (const std::int32_t signed_k : {k, -k})
            if (error_at(deg, signed_k) < error_at(deg, best)) best = signed_k;
    return best;
}

double AngleGrid::error_at(double deg, std::int32_t k) const {
    return std::abs(wrapped_deg(deg - k * angle_deg));
}

std::optional<AngleGrid> find_angle(const std::vector<double>& directions, std::vector<double> turns,
                                    double noise_deg, const std::function<bool(double)>& follow,
                                    WorkMeter& meter) {
    const std::vector<double> found = distinct_degrees(directions);
    std::erase_if(turns, [&](double turn) { return turn < 0.5 * least_angle_deg; });
    if (turns.empty()) // all in line, or no strokes meet
        for (const double direction : found)
            if (std::abs(direction) >= least_angle_deg) turns.push_back(std::abs(direction));
    const auto groups = value_groups(turns, noise_deg);
    if (groups.size() > most_turns) return std::nullopt;
    std::optional<AngleGrid> best;
    double least = HUGE_VAL;
    for (const double angle : angle_candidates(groups, std::max(least_angle_deg, 5 * noise_deg)))
        for (const bool closed : {true, false}) {
            AngleGrid grid{angle, 0};
            const double circle = 360 / angle, whole = std::round(circle);
            if (std::abs(circle - whole) < 0.12 && whole <= most_directions)
                grid.directions = static_cast<std::int32_t>(whole);
            if (closed != (grid.directions > 0)) continue;
            meter.add(found.size());
            const double allowed = closed ? std::max(noise_deg, 0.1 * angle) : noise_deg;
            const bool fits = std::ranges::all_of(
                found, [&](double direction) { return grid.error(direction) <= allowed; });
            if (!fits) continue;
            double cost = 0;
            std::uint64_t count = 0;
            for (const auto& [turn, number] : groups) {
                const double units = std::round(turn / angle);
                const bool direct = std::abs(turn - units * angle) <= allowed;
                cost += static_cast<double>(number) * (direct ? units : 10); // 10: by going round
                count += number;
            }
            cost /= static_cast<double>(std::max<std::uint64_t>(count, 1));
            if (cost < least - 1e-9) {
                least = cost;
                best = AngleGrid{refined(turns, grid, meter), grid.directions};
            }
        }
    if (best) return best;
    // Joints that went round lie near others, so that groups of a finer width tell the angle.
    auto fine = value_groups(turns, fine_turn_deg);
    fine.resize(std::min(fine.size(), most_followed_angles));
    for (const auto& turn : fine) {
        std::vector<double> direct = turns;
        std::erase_if(direct, [&](double joint) {
            return std::abs(std::remainder(joint, turn.first)) > fine_turn_deg;
        });
        const double angle = refined(direct, {turn.first, 0}, meter);
        if (follow(angle)) return AngleGrid{angle, 0};
    }
    return std::nullopt;
}

} // namespace graftal
