#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/languages/lower.h"
#include "compiler/passes/pipeline.h"
#include "compiler/povray/cut.h"
#include "compiler/scene/scene.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/zoom/reroot.h"

namespace graftal {

struct AnalysedModel;

struct CompileOptions {
    LowerOptions lower;
    PipelineOptions pipeline;
    std::optional<unsigned> steps;
    ImageSize size;
    CameraOverride camera;
    ZoomRequest zoom;
    DetailOptions detail; ///< its steps and root levels are filled in
    CutOptions cut;
    /// Decides on the view of a model, or of a part that is looked at by itself, in place of frame_model():
    /// the frames of an animation are framed together.
    std::function<View(const AnalysedModel&, bool part)> frame;
};

struct StageTime {
    std::string stage;
    double seconds = 0;
};

/// Of a graph: its objects, and its instances, which are its edges.
struct GraphSize {
    std::size_t objects = 0;
    std::size_t instances = 0;
};

/// A model after analysis: all that `stats`, `check`, `print` and `graph` need.
struct AnalysedModel {
    std::string path;
    GraphSize written; ///< of the graph that the text gives, before the passes
    Graph graph;       ///< after them
    Components components;
    Contraction contraction;
    std::vector<ObjectBounds> bounds;     ///< empty unless the contraction is proved or acyclic
    std::optional<unsigned> steps;        ///< levels of recursion; from the command line, else from the model
    std::optional<Derivation> derivation; ///< of an L-system
};

/// A model that is looked at: what every engine starts from.
struct ViewedModel {
    AnalysedModel model;
    View view;
    DetailOptions detail;
};

/// A model ready to emit.
struct CompiledModel {
    AnalysedModel model;
    View view;
    Cut cut;
};

/// One compilation: owns the sources and the diagnostics, so that both outlive the results.
struct Compilation {
    SourceMap sources;
    Diagnostics diagnostics;
    Status status; ///< the environment's, e.g. a model file that cannot be read
    std::vector<StageTime> times;
};

/// text -> graph -> passes -> analysis. A cycle that does not contract is an error, unless `for_report`:
/// then the verdict is part of the result. A model that draws nothing, where LowerOptions allow it, has a
/// graph without objects.
std::optional<AnalysedModel> analyse_model(const std::string& path, const CompileOptions& options,
                                           Compilation& compilation, bool for_report = false);

/// analyse_model, then the view.
std::optional<ViewedModel> view_model(const std::string& path, const CompileOptions& options,
                                      Compilation& compilation);

/// view_model, then the cut.
std::optional<CompiledModel> compile_model(const std::string& path, const CompileOptions& options,
                                           Compilation& compilation);

} // namespace graftal
