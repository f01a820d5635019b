#pragma once

// The values of the stages (README.md). Each is made once, and not changed after.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/detail_options.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/lower/derivation.h"
#include "compiler/lower/lower_options.h"
#include "compiler/scene/scene.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/zoom/address.h"
#include "compiler/zoom/magnification.h"
#include "compiler/zoom/near_ways.h"

namespace graftal {

struct OrbitModel;

struct StageTime {
    std::string stage;
    double seconds = 0;
};

/// Findings that a caller gets besides a value, and the texts that they point into.
struct Compilation {
    SourceMap sources;
    Diagnostics diagnostics;
    Status status; ///< the environment's, e.g. a model file that cannot be read
    std::vector<StageTime> times;
};

/// The text of the model's own file.
struct Source {
    std::string path; ///< "-": standard input
    std::string text;
};

/// A model as its texts say it.
struct LoweredModel {
    std::string path;
    std::optional<Graph> graph; ///< nothing of an orbit, and where nothing is drawn
    LowerNotes notes;
    double work_seconds = 0; ///< counted (support/stage_work.h)
};

/// Size of a graph: its objects, and its instances, which are its edges.
struct GraphSize {
    std::size_t objects = 0;
    std::size_t instances = 0;
};

/// A model after passes and analysis: all that `stats`, `check`, `print` and `graph` need. One that draws
/// nothing, where LowerOptions allow it, has a graph without objects.
struct AnalysedModel {
    std::string path;
    GraphSize written; ///< of the graph that the text gives, before the passes
    Graph graph;       ///< after them
    Components components;
    Contraction contraction;
    std::vector<ObjectBounds> bounds;      ///< empty unless the contraction is proved or acyclic
    std::optional<Derivation> derivation;  ///< of an L-system
    std::optional<GraphPath> at;           ///< where the zoom's address leads
    double work_seconds = 0;               ///< counted, of the lowering too (support/stage_work.h)
    std::shared_ptr<CloudPictures> clouds; ///< the session's; null: views of the model share no sky
};

/// A model that is looked at: what every engine starts from.
struct ViewedModel {
    std::shared_ptr<const AnalysedModel> model; ///< never null; under a zoom the one with a new root
    std::optional<unsigned> steps;              ///< levels of recursion, of the new root under a zoom
    View view;
    Magnification zoom; ///< how much larger than in the world lengths are
    /// Under a zoom: the paths from the model's root to the masters of the new root's instances. Else null.
    std::shared_ptr<const NearWays> ways = {};
};

} // namespace graftal
