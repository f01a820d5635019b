// The settings of `set`, and the scene that they make.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/colour_names.h"
#include "compiler/import/eisenscript/text.h"
#include "compiler/import/eisenscript/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"

namespace graftal::eisenscript {

// Settings

std::optional<double> Writer::number(const Setting& setting) {
    const std::optional<double> value = parse_number(setting.value);
    if (!value || !(std::abs(*value) <= 1e100))
        file_.diagnostics.error(setting.span, fmt::format("'{}' is not a number", setting.value));
    return value;
}

/// `[1 0 0]` or `[1,0,0]`.
std::vector<double> Writer::numbers(const Setting& setting, std::size_t count) {
    std::vector<double> values;
    std::string word;
    for (const char c : setting.value + " ") {
        if (c != ' ' && c != ',' && c != '[' && c != ']') {
            word += c;
            continue;
        }
        const std::optional<double> value = parse_number(word);
        if (value && std::abs(*value) <= 1e9) values.push_back(*value);
        word.clear();
    }
    if (values.size() != count)
        file_.diagnostics.error(setting.span,
                                fmt::format("'{}' takes {} numbers in brackets", setting.key, count));
    return values;
}

void Writer::read_settings() {
    for (std::size_t rule = 0; rule < script_.rules.size(); ++rule)
        for (const Setting& setting : script_.rules[rule].settings) {
            if (rule == 0 || setting.key == "background")
                set(setting);
            else
                file_.diagnostics.warning(
                    setting.span, fmt::format("'set {}' within a rule changes nothing here", setting.key));
        }
}

void Writer::set(const Setting& setting) {
    const std::string& key = setting.key;
    const auto whole = [&](double most) -> std::optional<double> {
        const std::optional<double> value = number(setting);
        if (!value || (*value == std::floor(*value) && *value >= 0))
            return value ? std::optional(std::min(*value, most)) : value;
        file_.diagnostics.error(setting.span, fmt::format("'{}' is a whole number", key));
        return std::nullopt;
    };
    if (key == "maxdepth" || key == "md") {
        if (const auto value = whole(1e6)) limits_.generations = static_cast<int>(*value);
    } else if (key == "maxobjects") {
        if (const auto value = whole(1e12)) limits_.objects = *value;
    } else if (key == "minsize") {
        limits_.least_size = number(setting);
    } else if (key == "maxsize") {
        limits_.most_size = number(setting);
    } else if (key == "background") {
        background_ = colour_named(setting.value);
        if (!background_)
            file_.diagnostics.error(setting.span, fmt::format("'{}' is not a colour", setting.value));
    } else if (key == "colorpool") {
        pool_ = in_small_letters(setting.value);
        if (pool_ == "grayscale") pool_ = "greyscale";
        if (pool_.starts_with("list:")) {
            pool_colours_.clear();
            std::string_view rest = std::string_view(pool_).substr(5);
            while (true) {
                const std::size_t comma = std::min(rest.find(','), rest.size());
                const auto rgb = colour_named(rest.substr(0, comma));
                if (!rgb)
                    file_.diagnostics.error(setting.span,
                                            fmt::format("'{}' is not a colour", rest.substr(0, comma)));
                else
                    pool_colours_.push_back(hsv_text(*rgb));
                if (comma == rest.size()) break;
                rest.remove_prefix(comma + 1);
            }
        } else if (pool_.starts_with("image:")) {
            file_.diagnostics
                .error(setting.span, "a pool of colours from a picture ('image:') is not translated")
                .with_hint("name the colours: set colorpool list:orange,#346");
        } else if (pool_ != "randomhue" && pool_ != "randomrgb" && pool_ != "greyscale") {
            file_.diagnostics.error(setting.span, fmt::format("unknown pool of colours '{}'", setting.value));
        }
    } else if (key == "translation" || key == "pivot") {
        (key == "pivot" ? camera_.pivot : camera_.translation) = numbers(setting, 3);
    } else if (key == "rotation") {
        camera_.rotation = numbers(setting, 9);
    } else if (key == "scale") {
        camera_.scale = number(setting);
    } else if (key == "perspective-angle") {
        camera_.angle_deg = number(setting);
    } else if (key == "seed") {
        file_.diagnostics.note(setting.span, "the seed is an option here, and chooses other numbers: --seed");
    } else if (key == "recursion" || key == "syncrandom" || key == "rng" || key == "template" ||
               key == "opengl") {
        file_.diagnostics.warning(setting.span,
                                  fmt::format("'set {} {}' changes nothing here", key, setting.value));
    } else if (key.starts_with("raytracer::")) {
        const std::string rest = key.substr(11);
        const std::size_t colons = rest.find("::");
        const std::string of = colons == std::string::npos ? "" : rest.substr(0, colons);
        const std::string what = colons == std::string::npos ? rest : rest.substr(colons + 2);
        if (!of.empty() && what == "reflection") {
            finishes_[of].reflection = number(setting);
        } else if (!of.empty() && what == "phong") {
            const std::vector<double> phong = numbers(setting, 3);
            if (phong.size() == 3) {
                finishes_[of].ambient = phong[0];
                finishes_[of].diffuse = phong[1];
                finishes_[of].specular = phong[2];
            }
        } else {
            file_.diagnostics.warning(setting.span,
                                      fmt::format("'{}' is of Structure Synth's own raytracer, and "
                                                  "changes nothing here",
                                                  key));
        }
    } else {
        file_.diagnostics.error(setting.span, fmt::format("unknown setting '{}'", key));
    }
}

void Writer::write_scene() {
    if (background_) line(fmt::format("background: {}", linear_text(*background_)));
    write_camera();
    for (const auto& [name, finish] : finishes_) {
        std::string fields;
        const auto add = [&](const char* field, const std::optional<double>& value) {
            if (value) fields += fmt::format("  {}: {}", field, shortest(std::clamp(*value, 0.0, 1.0)));
        };
        add("ambient", finish.ambient);
        add("diffuse", finish.diffuse);
        add("specular", finish.specular);
        add("reflection", finish.reflection);
        line(fmt::format("material {} {{{} }}", plain_name(name), fields));
    }
}

/// Reports that graftal chooses the camera itself, where the script sets one.
void Writer::report_no_camera() {
    std::string words;
    Span span;
    for (const Setting& setting : script_.rules.front().settings) {
        static constexpr std::array names = {"translation", "rotation", "pivot", "scale",
                                             "perspective-angle"};
        if (std::ranges::find(names, setting.key) == names.end()) continue;
        words += fmt::format("{}'set {}'", words.empty() ? "" : ", ", setting.key);
        if (!span.known()) span = setting.span;
    }
    if (words.empty()) return;
    file_.diagnostics
        .warning(span, fmt::format("{} {} no camera, and {} nothing here", words,
                                   words.find(',') == std::string::npos ? "makes" : "make",
                                   words.find(',') == std::string::npos ? "changes" : "change"))
        .with_hint(
            "a camera is 'set translation [0 0 -20]' and 'set scale 0.5', a 'rotation' of nine numbers, "
            "and a 'pivot'");
}

/// Structure Synth moves the scene: eye = translation + scale * rotation * (point - pivot), and looks along
/// -z.
void Writer::write_camera() {
    if (!camera_.translation || camera_.translation->size() != 3 || !camera_.scale || !(*camera_.scale > 0))
        return report_no_camera();
    Mat3 eye_from_world(1.0);
    if (camera_.rotation && camera_.rotation->size() == 9)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                eye_from_world[column][row] = (*camera_.rotation)[static_cast<std::size_t>(3 * row + column)];
    Vec3 pivot(0.0);
    if (camera_.pivot && camera_.pivot->size() == 3)
        pivot = {(*camera_.pivot)[0], (*camera_.pivot)[1], (*camera_.pivot)[2]};
    const Vec3 moved((*camera_.translation)[0], (*camera_.translation)[1], (*camera_.translation)[2]);
    const Mat3 world_from_eye = glm::transpose(eye_from_world);
    const Vec3 location = pivot - Vec3(0.5) - world_from_eye * moved / *camera_.scale;
    const Vec3 ahead = world_from_eye * Vec3(0, 0, -1), up = world_from_eye * Vec3(0, 1, 0);
    const double distance = std::max(1e-3, std::abs(moved.z) / *camera_.scale);
    if (!(glm::length(glm::cross(ahead, up)) > 0.1)) return report_no_camera();
    const double upright = std::clamp(camera_.angle_deg.value_or(22), 1.0, 150.0) * std::numbers::pi / 180;
    const double across = 2 * std::atan(std::tan(upright / 2) * 16 / 9) * 180 / std::numbers::pi;
    line(fmt::format("camera {{ location: {}  look_at: {}  up: {}  angle: {} }}", vector_text(location),
                     vector_text(location + distance * ahead), vector_text(up), shortest(across)));
}

} // namespace graftal::eisenscript
