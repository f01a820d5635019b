#include "compiler/import/cfdg/text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

/// A number that was computed: that of few digits which it differs from by rounding errors, or itself.
std::string tidy(double value) {
    const double few = parse_number(fmt::format("{:.12g}", value)).value_or(value);
    return shortest(std::abs(few - value) <= 1e-15 * std::abs(value) ? few : value);
}

/// The sum of steps of saturation, brightness or alpha: a share of the way to a goal.
struct Way {
    double goal = 0, share = 0;

    void add(double to, double by) {
        const double kept = (1 - share) * (1 - by), whole = 1 - kept;
        if (whole > 0) goal = std::clamp((goal * share * (1 - by) + to * by) / whole, 0.0, 1.0);
        share = whole;
    }
};

double wrapped_hue(double degrees) {
    return degrees - 360 * std::floor(degrees / 360);
}

/// The way of a step of saturation, brightness or alpha.
bool add_step(const ColourStep& step, double target, Way& way) {
    const double by = std::abs(step.amount);
    if (step.kind == ColourStep::Kind::change) {
        way.add(step.amount > 0 ? 1 : 0, by);
        return true;
    }
    const double goal = step.kind == ColourStep::Kind::toward ? step.goal : target;
    if (step.amount >= 0)
        way.add(goal, by);
    else if (goal <= 0 || goal >= 1) // away from one end is to the other
        way.add(goal <= 0 ? 1 : 0, by);
    else
        return false;
    return true;
}

void change_target(const ColourStep& step, double& target) {
    if (step.channel == Channel::hue)
        target = wrapped_hue(target + step.amount);
    else
        target += std::abs(step.amount) * ((step.amount > 0 ? 1 : 0) - target);
}

} // namespace

std::string moves_text(const Affine& map) {
    const auto& m = map.linear;
    const Vec3 at = map.translation;
    std::string text;
    const double size = std::hypot(m[0][0], m[0][1]);
    const bool uniform = std::abs(m[2][2] - size) <= 1e-15 * size;
    const bool similar = std::abs(m[0][0] - m[1][1]) <= 1e-15 * size &&
                         std::abs(m[0][1] + m[1][0]) <= 1e-15 * size && (m[2][2] == 1 || uniform);
    if (!similar)
        return fmt::format("  matrix: {}, {}, 0, {},  {}, {}, 0, {},  0, 0, {}, {}", shortest(m[0][0]),
                           shortest(m[1][0]), shortest(at.x), shortest(m[0][1]), shortest(m[1][1]),
                           shortest(at.y), shortest(m[2][2]), shortest(at.z));
    if (const std::string scale = tidy(size); scale != "1")
        text += uniform ? "  scale: " + scale : fmt::format("  scale: {0}, {0}, 1", scale);
    const double angle_deg = std::atan2(m[0][1], m[0][0]) * 180 / std::numbers::pi;
    if (angle_deg != 0) text += "  rotate: z, " + tidy(angle_deg);
    if (at != Vec3(0.0))
        text += fmt::format("  translate: {}, {}, {}", shortest(at.x), shortest(at.y), shortest(at.z));
    return text;
}

std::optional<std::string> ink_text(const std::vector<ColourStep>& steps, Target& target) {
    std::array<Way, 4> ways;
    std::string text;
    double turn = 0;
    const auto flush = [&] {
        if (wrapped_hue(turn) != 0) text += " hue " + tidy(std::remainder(turn, 360));
        turn = 0;
    };
    for (const ColourStep& step : steps) {
        const auto channel = static_cast<std::size_t>(step.channel);
        if (step.kind == ColourStep::Kind::target) {
            change_target(step, target[channel]);
        } else if (step.channel != Channel::hue) {
            if (!add_step(step, target[channel], ways[channel])) return std::nullopt;
        } else if (step.kind == ColourStep::Kind::change) {
            turn += step.amount;
        } else if (step.amount != 0) {
            flush();
            const double goal = step.kind == ColourStep::Kind::toward ? step.goal : target[0];
            text += fmt::format(" hue {} to {} by {}", step.amount > 0 ? "up" : "down",
                                tidy(wrapped_hue(goal)), tidy(std::abs(step.amount)));
        }
    }
    flush();
    static constexpr std::array<const char*, 4> names = {"hue", "saturation", "value", "alpha"};
    for (std::size_t channel = 1; channel < ways.size(); ++channel)
        if (const Way& way = ways[channel]; way.share > 0)
            text += fmt::format(" {} to {} by {}", names[channel], tidy(way.goal), tidy(way.share));
    return text.empty() ? text : "  ink {" + text + " }";
}

bool is_plain(const std::vector<ColourStep>& steps) {
    using Kind = ColourStep::Kind;
    return std::ranges::all_of(steps, [](const ColourStep& step) {
        const bool toward = step.kind == Kind::toward && step.channel != Channel::hue && step.amount >= 0;
        return step.kind == Kind::change || toward;
    });
}

std::vector<ColourStep> shortened(const std::vector<ColourStep>& steps) {
    using Kind = ColourStep::Kind;
    if (!is_plain(steps)) return steps;
    std::array<Way, 4> ways;
    double turn = 0;
    for (const ColourStep& step : steps)
        if (step.channel == Channel::hue)
            turn += step.amount;
        else
            add_step(step, 0, ways[static_cast<std::size_t>(step.channel)]);
    std::vector<ColourStep> fewer;
    if (turn != 0) fewer.push_back({Kind::change, Channel::hue, turn});
    for (std::size_t channel = 1; channel < ways.size(); ++channel)
        if (const Way& way = ways[channel]; way.share > 0)
            fewer.push_back({Kind::toward, static_cast<Channel>(channel), way.share, way.goal});
    return fewer;
}

} // namespace graftal::cfdg
