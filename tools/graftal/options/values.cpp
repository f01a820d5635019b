#include "tools/graftal/options/values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

std::optional<std::uint64_t> parse_whole(std::string_view text, std::uint64_t least, std::uint64_t most) {
    const auto value = parse_whole<std::uint64_t>(text);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

std::optional<ImageSize> parse_large_size(std::string_view text) {
    constexpr std::uint64_t longest_side = 131'072;
    const std::size_t cross = text.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto width = parse_whole(text.substr(0, cross), 1, longest_side);
    const auto height = parse_whole(text.substr(cross + 1), 1, longest_side);
    if (!width || !height) return std::nullopt;
    return ImageSize{static_cast<int>(*width), static_cast<int>(*height)};
}

bool is_drawn_at_once(ImageSize size) {
    constexpr int longest_side = 32'768;
    constexpr std::uint64_t most_pixels = 1u << 28;
    return std::max(size.width, size.height) <= longest_side && whole_of(size).pixels() <= most_pixels;
}

std::optional<ImageSize> parse_size(std::string_view text) {
    const std::optional<ImageSize> size = parse_large_size(text);
    return size && is_drawn_at_once(*size) ? size : std::nullopt;
}

std::optional<Tile> parse_tile(std::string_view text) {
    constexpr std::uint64_t most = INT32_MAX;
    const std::size_t first = text.find(',');
    if (first == std::string_view::npos) return std::nullopt;
    const std::string_view rest = text.substr(first + 1);
    const std::size_t second = rest.find(',');
    if (second == std::string_view::npos) return std::nullopt;
    const auto x = parse_whole(text.substr(0, first), 0, most);
    const auto y = parse_whole(rest.substr(0, second), 0, most);
    const auto size = parse_size(rest.substr(second + 1));
    if (!x || !y || !size) return std::nullopt;
    return Tile{static_cast<int>(*x), static_cast<int>(*y), size->width, size->height};
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
    std::uint64_t unit = 1;
    constexpr std::string_view suffixes = "KMGT";
    if (!text.empty()) {
        const std::size_t power = suffixes.find(text.back());
        if (power != std::string_view::npos) {
            unit <<= 10 * (power + 1);
            text.remove_suffix(1);
        }
    }
    const auto count = parse_whole(text, 1, UINT64_MAX / unit);
    if (!count) return std::nullopt;
    return *count * unit;
}

std::optional<double> parse_at_least(std::string_view text, double least) {
    const std::optional<double> value = parse_number(text);
    return value && std::isfinite(*value) && *value >= least ? value : std::nullopt;
}

std::optional<double> parse_share(std::string_view text) {
    const std::optional<double> value = parse_number(text);
    return value && *value >= 0 && *value <= 1 ? value : std::nullopt;
}

std::optional<StepsValue> parse_steps(std::string_view text, std::uint64_t most) {
    if (const auto whole = parse_whole(text, 0, most)) return StepsValue{whole, static_cast<double>(*whole)};
    if (text.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
    const std::optional<double> time = parse_at_least(text, 0);
    if (!time || *time > static_cast<double>(most)) return std::nullopt;
    if (*time == std::floor(*time)) return StepsValue{static_cast<std::uint64_t>(*time), *time};
    return StepsValue{std::nullopt, *time};
}

std::optional<Magnification> parse_zoom(std::string_view text) {
    const std::optional<Magnification> zoom = Magnification::parse(text);
    return zoom && zoom->log2() >= std::log2(least_size) ? zoom : std::nullopt;
}

std::optional<std::pair<std::string, double>> parse_setting(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) return std::nullopt;
    const std::optional<double> value = parse_number(text.substr(equals + 1));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return std::pair(std::string(text.substr(0, equals)), *value);
}

std::optional<Vec3> parse_vector(std::string_view text) {
    Vec3 vector(0.0);
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
        const std::optional<double> value = parse_number(text.substr(0, comma));
        if (!value || !std::isfinite(*value)) return std::nullopt;
        vector[i] = *value;
        text.remove_prefix(i == 2 ? text.size() : comma + 1);
    }
    return vector;
}

namespace {

std::string set_camera_word(std::string_view word, CameraOverride& camera) {
    if (word == "orthographic") {
        camera.orthographic = true;
        return {};
    }
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals);
    const std::string_view text = word.substr(std::min(equals + 1, word.size()));
    const std::pair<std::string_view, std::optional<Vec3>*> vectors[] = {{"location", &camera.location},
                                                                         {"look_at", &camera.look_at},
                                                                         {"up", &camera.up},
                                                                         {"focus", &camera.focus}};
    for (const auto& [vector_name, vector] : vectors) {
        if (name != vector_name) continue;
        *vector = parse_vector(text);
        if (!*vector) return fmt::format("'{}' is not of the form {}=X,Y,Z, without blanks", word, name);
        const bool fits =
            vector == &camera.up ? **vector == Vec3(0.0) || is_direction(**vector) : is_place(**vector);
        return fits ? "" : fmt::format("'{}': {}", word, range_hint);
    }
    const std::optional<double> number = parse_number(text);
    if (name == "angle") {
        camera.angle_deg = number;
        return number && *number >= least_size && *number < 180 ? ""
                                                                : "angle must lie between 0 and 180 degrees";
    }
    if (name == "width") {
        camera.width = number;
        if (!number || !std::isfinite(*number) || !(*number > 0)) return "width must be a positive number";
        return is_size(*number) ? "" : fmt::format("'{}': {}", word, range_hint);
    }
    if (name == "aperture") {
        camera.aperture = number;
        if (number && (*number == 0 || (*number > 0 && is_size(*number)))) return {};
        return "aperture must be 0, or a radius from 1e-100 to 1e100";
    }
    return fmt::format(
        "'{}' is none of location=, look_at=, up=, angle=, orthographic, width=, aperture=, focus=", word);
}

} // namespace

namespace {

bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

} // namespace

std::optional<std::string_view> take_setting(std::string_view& text) {
    constexpr std::string_view blanks = " \t\n";
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return std::nullopt;
    text.remove_prefix(begin);
    std::string_view word = text.substr(0, text.find_first_of(blanks));
    for (std::size_t comma = word.find(','); comma < word.size(); comma = word.find(',', comma + 1))
        if (comma + 1 == word.size() || begins_name(word[comma + 1])) {
            text.remove_prefix(comma + 1);
            return word.substr(0, comma);
        }
    text.remove_prefix(word.size());
    return word;
}

std::string parse_camera(std::string_view text, CameraOverride& camera) {
    while (const std::optional<std::string_view> word = take_setting(text)) {
        const std::string problem = set_camera_word(*word, camera);
        if (!problem.empty()) return problem;
    }
    return {};
}

} // namespace graftal
