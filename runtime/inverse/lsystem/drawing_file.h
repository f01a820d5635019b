#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/session/session.h"
#include "runtime/inverse/lsystem/stroke_graph.h"

namespace graftal {

/// Whether a name ends as those of drawings do: .svg, .csv, .txt or .lsys.
bool is_drawing_name(std::string_view path);

/// Reads the straight lines of a drawing, in its order and direction, with y up: of an SVG, of a list with
/// four numbers a line, or what the segments of an L-system draw. Nothing comes back after errors in
/// `compilation.diagnostics`, or with a failed `compilation.status`.
std::optional<Strokes> read_drawing(const std::string& path, const StageOptions& compile,
                                    const Control& control, Compilation& compilation);

/// The lines of an SVG; nothing, with the problem, where it has none or is broken, or has curves.
std::optional<Strokes> svg_strokes(const std::string& text, std::string& problem);

/// The segments that an L-system draws.
std::optional<Strokes> model_strokes(Session& session, StageOptions options, Compilation& compilation);

} // namespace graftal
