#pragma once

#include <memory>
#include <optional>

#include "compiler/povray/cut/cut.h"
#include "compiler/session/session.h"

namespace graftal {

/// A model ready to be written as a scene for POV-Ray.
struct CompiledModel {
    std::shared_ptr<const AnalysedModel> model; ///< never null; under a zoom the one with a new root
    std::optional<unsigned> steps;              ///< levels of recursion, of the new root under a zoom
    View view;
    Cut cut;
};

/// Cuts the session's model for POV-Ray. Null after errors in the compilation, or with its failed status. A
/// session that keeps nothing gives up what it has prepared.
std::shared_ptr<const CompiledModel> compile_scene(Session& session, const StageOptions& options,
                                                   Compilation& compilation,
                                                   const CutOptions& cut_options = {});

} // namespace graftal
