#include "runtime/inverse/lsystem/drawing_file.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "compiler/lower/plant.h"
#include "compiler/support/number.h"
#include "compiler/support/text_encoding.h"
#include "runtime/render/picture_session.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

constexpr std::size_t most_drawing_bytes = 256u << 20;
constexpr std::size_t most_listed_strokes = 1'000'000;

/// The words of a line of a list.
struct ListedLine {
    std::vector<double> numbers;
    bool has_names = false; ///< words that are no numbers
};

ListedLine read_line(std::string_view line) {
    constexpr std::string_view separators = " \t,;";
    ListedLine read;
    line = line.substr(0, line.find('#'));
    for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
        if (const std::optional<double> number = parse_number(line.substr(at, end - at)))
            read.numbers.push_back(*number);
        else
            read.has_names = true;
        at = line.find_first_not_of(separators, end);
    }
    return read;
}

std::optional<Strokes> listed_strokes(std::string_view text, std::string& problem) {
    Strokes strokes;
    std::size_t number = 0;
    bool may_name_columns = true;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        ++number;
        const auto [values, has_names] = read_line(line);
        if (values.empty() && !has_names) continue;
        const bool names_columns = may_name_columns && values.empty();
        may_name_columns = false;
        if (names_columns) continue;
        if (has_names || values.size() != 4) {
            problem = fmt::format("line {} has no four numbers x1, y1, x2, y2", number);
            return std::nullopt;
        }
        if (strokes.size() == most_listed_strokes) {
            problem = fmt::format("it has more than {} lines", most_listed_strokes);
            return std::nullopt;
        }
        strokes.push_back({{values[0], values[1]}, {values[2], values[3]}});
    }
    return strokes;
}

} // namespace

bool is_drawing_name(std::string_view path) {
    constexpr std::array<std::string_view, 4> endings = {".svg", ".csv", ".txt", ".lsys"};
    return std::ranges::any_of(endings, [&](std::string_view ending) { return path.ends_with(ending); });
}

std::optional<Strokes> model_strokes(Session& session, StageOptions options, Compilation& compilation) {
    options.lower.in_place = LowerOptions::InPlace::plant;
    const std::shared_ptr<const LoweredModel> lowered = session.lowered(options, compilation);
    if (!lowered || !lowered->notes.plant) return std::nullopt;
    Strokes strokes;
    for (const PlantModule& module : lowered->notes.plant->modules) {
        if (module.organ != Organ::segment) continue;
        const Stroke stroke{{module.start.x, module.start.y}, {module.end.x, module.end.y}};
        if (std::abs(module.start.z) > 1e-9 || std::abs(module.end.z) > 1e-9) {
            compilation.diagnostics.error({}, "this model draws in space, and not in a plane")
                .with_hint("only turns by + and - and | stay in the plane");
            return std::nullopt;
        }
        if (stroke.from != stroke.to) strokes.push_back(stroke);
    }
    return strokes;
}

std::optional<Strokes> read_drawing(const std::string& path, const StageOptions& compile,
                                    const Control& control, Compilation& compilation) {
    if (path.ends_with(".lsys")) {
        PictureSession session(path);
        session.set_control(control);
        return model_strokes(session, compile, compilation);
    }
    std::string text, problem;
    compilation.status = read_text(path, text, most_drawing_bytes);
    if (!compilation.status.ok()) return std::nullopt;
    std::optional<Strokes> strokes =
        path.ends_with(".svg") ? svg_strokes(text, problem)
                               : listed_strokes(decoded_text(std::move(text), OtherBytes::kept), problem);
    if (!strokes)
        compilation.diagnostics.error({}, fmt::format("the drawing '{}' cannot be read: {}", path, problem));
    return strokes;
}

} // namespace graftal
