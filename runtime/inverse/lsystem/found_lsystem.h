#pragma once

#include <functional>
#include <optional>
#include <string>

#include "compiler/session/session.h"
#include "runtime/inverse/lsystem/unfolding.h"

namespace graftal {

struct FindLsystemOptions {
    std::string drawing; ///< a file (drawing_file.h)
    double tolerance =
        0.01;             ///< ends of lines that are no farther apart meet, as a share of the shortest line
    double seconds = 30;  ///< of one processor, by counted work
    StageOptions compile; ///< of a drawing that is a model
    std::string made_by;  ///< the command line, for the model's comment
    std::function<void(double share, int round)> on_progress;
};

/// An L-system that draws what a drawing shows, and how well.
struct FoundLsystem {
    std::string text;          ///< `.lsys`
    std::size_t letters = 0;   ///< of the axiom and all productions, turns and brackets left out
    std::uint64_t strokes = 0; ///< of the drawing, in units
    std::uint64_t redrawn = 0; ///< that the model draws again, between the same places
    double farthest = 0;       ///< place of the drawing from the model's, as a share of a unit
    unsigned steps = 0;
    double angle_deg = 0;
    double factor = 1;  ///< of lengths from a step to the next
    double seconds = 0; ///< of counted work
};

/// The smallest L-system found that draws each line of the drawing, as often as it lies there. It depends on
/// the drawing's lines, tolerance and work alone. Nothing comes back after errors in
/// `compilation.diagnostics`, which says where none was found; or with a failed `compilation.status`.
std::optional<FoundLsystem> find_lsystem(const FindLsystemOptions& options, const CancelFlag& cancel,
                                         Compilation& compilation);

/// The text of a found system, as a model whose drawing lies in the directions of the graph's.
std::string lsystem_text(const FoundGrammar& grammar, const StrokeGraph& graph);

} // namespace graftal
