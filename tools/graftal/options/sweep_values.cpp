#include "tools/graftal/options/sweep_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/graftal/options/values.h"

namespace graftal {

namespace {

constexpr std::string_view between = "..";

using WholeRange = std::pair<std::uint64_t, std::uint64_t>;

std::optional<WholeRange> parse_whole_range(std::string_view text, std::uint64_t most) {
    const auto range = parse_range(text);
    if (!range) return std::nullopt;
    const auto from = parse_whole(range->first, 0, most), to = parse_whole(range->second, 0, most);
    if (!from || !to) return std::nullopt;
    return WholeRange(*from, *to);
}

std::string text_of(Vec3 v) {
    return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z);
}

/// One swept word of a camera: `from` and `to` each set the same member.
Sweep camera_sweep(const std::string& name, const CameraOverride& from, const CameraOverride& to) {
    const auto apply = [=](double t, StageOptions& options) {
        CameraOverride& camera = options.view.camera;
        std::string text = "--camera " + name + "=";
        const auto sweep_vector = [&](auto member) {
            if (!(from.*member)) return;
            camera.*member = swept(*(from.*member), *(to.*member), t);
            text += text_of(*(camera.*member));
        };
        for (const auto member : {&CameraOverride::location, &CameraOverride::look_at, &CameraOverride::up,
                                  &CameraOverride::focus})
            sweep_vector(member);
        if (from.angle_deg) camera.angle_deg = swept(*from.angle_deg, *to.angle_deg, t);
        if (from.width) camera.width = swept_by_factor(*from.width, *to.width, t);
        if (from.aperture) camera.aperture = swept(*from.aperture, *to.aperture, t);
        if (from.angle_deg) text += fmt::format("{:.6g}", *camera.angle_deg);
        if (from.width) text += fmt::format("{:.6g}", *camera.width);
        if (from.aperture) text += fmt::format("{:.6g}", *camera.aperture);
        return text;
    };
    return {"--camera " + name, apply};
}

/// Values without a time lie evenly between their neighbours.
void spread_evenly(std::vector<SweepKey>& keys, const std::vector<bool>& timed) {
    for (std::size_t begin = 0, end = 1; end < keys.size(); ++end) {
        if (!timed[end]) continue;
        for (std::size_t i = begin + 1; i < end; ++i)
            keys[i].t = swept(keys[begin].t, keys[end].t,
                              static_cast<double>(i - begin) / static_cast<double>(end - begin));
        begin = end;
    }
}

/// "NAME=A" and "B@0.3..C".
std::optional<Sweep> parse_key_sweep(const std::pair<std::string, std::string>& range) {
    const auto first = parse_setting(range.first);
    if (!first) return std::nullopt;
    std::vector<SweepKey> keys{{0, first->second}};
    std::vector<bool> timed{true};
    for (std::string_view rest = range.second;;) {
        const std::size_t end = std::min(rest.find(between), rest.size());
        const std::string_view key = rest.substr(0, end);
        const std::size_t at = std::min(key.find('@'), key.size());
        const auto value = parse_setting(first->first + "=" + std::string(key.substr(0, at)));
        if (!value) return std::nullopt;
        keys.push_back({1, value->second});
        timed.push_back(at < key.size());
        if (timed.back()) {
            const auto t = parse_at_least(key.substr(at + 1), 0);
            if (!t || *t > 1) return std::nullopt;
            keys.back().t = *t;
        }
        if (end == rest.size()) break;
        rest.remove_prefix(end + between.size());
    }
    timed.back() = true;
    spread_evenly(keys, timed);
    for (std::size_t i = 1; i < keys.size(); ++i)
        if (!(keys[i].t > keys[i - 1].t)) return std::nullopt;
    const auto apply = [keys, name = first->first](double t, StageOptions& options) {
        const double value = options.lower.set[name] = swept_by_keys(keys, t);
        return fmt::format("--set {}={:.6g}", name, value);
    };
    return Sweep{"--set " + first->first, apply};
}

} // namespace

std::optional<std::pair<std::string, std::string>> parse_range(std::string_view text) {
    const std::size_t at = text.find(between);
    if (at == std::string_view::npos) return std::nullopt;
    return std::pair(std::string(text.substr(0, at)), std::string(text.substr(at + between.size())));
}

std::optional<Sweep> parse_steps_sweep(std::string_view text, std::uint64_t most) {
    const auto range = parse_range(text);
    if (!range) return std::nullopt;
    const auto from = parse_steps(range->first, most), to = parse_steps(range->second, most);
    if (!from || !to) return std::nullopt;
    const auto apply = [a = *from, b = *to](double t, StageOptions& options) {
        options.lower.time = swept(a.time, b.time, t);
        options.lower.steps.reset();
        if (!a.whole || !b.whole) return fmt::format("--steps {:.6g}", *options.lower.time);
        options.lower.steps = static_cast<unsigned>(swept_whole(*a.whole, *b.whole, t));
        return fmt::format("--steps {}", *options.lower.steps);
    };
    return Sweep{"--steps", apply};
}

std::optional<Sweep> parse_seed_sweep(std::string_view text) {
    const auto range = parse_whole_range(text, UINT64_MAX);
    if (!range) return std::nullopt;
    return Sweep{"--seed", [range = *range](double t, StageOptions& options) {
                     options.lower.seed = swept_whole(range.first, range.second, t);
                     return fmt::format("--seed {}", *options.lower.seed);
                 }};
}

std::optional<Sweep> parse_setting_sweep(std::string_view text) {
    const auto range = parse_range(text);
    if (!range) return std::nullopt;
    if (range->second.find(between) != std::string::npos || range->second.find('@') != std::string::npos)
        return parse_key_sweep(*range);
    const std::size_t colon = std::min(range->second.find(':'), range->second.size());
    const auto from = parse_setting(range->first);
    if (!from) return std::nullopt;
    const auto to = parse_setting(from->first + "=" + range->second.substr(0, colon));
    if (!to) return std::nullopt;
    double step = 0;
    if (colon < range->second.size()) {
        const auto given = parse_at_least(range->second.substr(colon + 1), 0);
        if (!given || !(*given > 0)) return std::nullopt;
        step = *given;
    }
    const auto apply = [=, name = from->first, a = from->second, b = to->second](double t,
                                                                                 StageOptions& options) {
        const double value = step > 0 ? swept_by_steps(a, b, step, t) : swept(a, b, t);
        options.lower.set[name] = value;
        return fmt::format("--set {}={:.6g}", name, value);
    };
    return Sweep{"--set " + from->first, apply};
}

std::optional<Sweep> parse_zoom_sweep(std::string_view text) {
    const auto range = parse_range(text);
    if (!range) return std::nullopt;
    const auto from = parse_zoom(range->first), to = parse_zoom(range->second);
    if (!from || !to) return std::nullopt;
    return Sweep{"--zoom", [from = from->log2(), to = to->log2()](double t, StageOptions& options) {
                     const double log2 = swept(from, to, t);
                     options.view.zoom.zoom = Magnification::exp2(log2);
                     return fmt::format("--zoom 2^{:.6g}", log2);
                 }};
}

std::string parse_camera_sweeps(std::string_view text, CameraOverride& camera, std::vector<Sweep>& sweeps) {
    while (const std::optional<std::string_view> taken = take_setting(text)) {
        const std::string_view word = *taken;
        const std::string name(word.substr(0, word.find('=')));
        const auto range = parse_range(word);
        CameraOverride from, to;
        std::string problem = range ? parse_camera(range->first, from) : parse_camera(word, camera);
        if (range && problem.empty()) problem = parse_camera(name + "=" + range->second, to);
        if (!problem.empty()) return problem;
        drop_sweep(sweeps, "--camera " + name);
        if (range) sweeps.push_back(camera_sweep(name, from, to));
    }
    return {};
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    const std::optional<double> rate = parse_at_least(text, 0.01);
    if (!rate || *rate > 240) return std::nullopt;
    return FrameRate{static_cast<int>(std::lround(100 * *rate))};
}

std::optional<double> parse_turn(std::string_view text) {
    const std::optional<double> turn = parse_at_least(text, -36000);
    return turn && *turn <= 36000 ? turn : std::nullopt;
}

} // namespace graftal
