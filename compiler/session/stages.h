#pragma once

// The stages of the compiler as functions of values (README.md). A Session calls them; nothing is kept here.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/passes/pipeline.h"
#include "compiler/session/stage_options.h"
#include "compiler/session/values.h"
#include "compiler/support/control.h"

namespace graftal {

/// Reads the model's own file, which the translator finds in the path. A path that leads out of `root` is an
/// error in `diagnostics`; a file that cannot be read gives a failed `status`.
std::optional<Source> read_source(const std::string& path, const std::string& root, const Files& files,
                                  const Translator& translator, Diagnostics& diagnostics, Status& status);

/// The seconds of counted work (support/stage_work.h) that the stages up to the analysis may take together:
/// as many as the picture, but a few in any case.
double stage_work_limit(const StageOptions& options);
/// The account of the stages, after so much work of those before.
StageWork stage_work(const StageOptions& options, double spent_seconds = 0);

/// Text -> graph. Nothing after an error. `sources` gets the texts of all files that the model reads.
std::optional<LoweredModel> lower_source(const Source& source, const LowerOptions& options,
                                         const LowerHelp& help, SourceMap& sources, Diagnostics& diagnostics);

/// Whether `name` is "" or names a pass; else an error says so.
bool check_pass(const std::string& name, Diagnostics& diagnostics);

/// Passes and analysis. A model that does not converge has its verdict and no bounds. Nothing after an error:
/// the model is larger than numbers go, or has no such address. `at`: of a zoom. `times` gets those of its
/// parts. Requires that the model is no orbit, and check_pass().
std::optional<AnalysedModel> analyse(LoweredModel lowered, const std::optional<Address>& at,
                                     const PipelineOptions& options, Diagnostics& diagnostics,
                                     std::vector<StageTime>& times, const Control& control = no_control());

/// True, after an error, for a model that is not proved to converge.
bool refuse_divergent(const AnalysedModel& model, Diagnostics& diagnostics);

/// The levels of recursion that are drawn, where the command line asks for `asked`. The steps of an L-system
/// are spent already; an object that it places recurs as its own file says.
std::optional<unsigned> levels_of(const AnalysedModel& model, std::optional<unsigned> asked);

/// The model with a camera, and under a zoom with a new root. Nothing after an error. Requires a model that
/// refuse_divergent() lets pass. `control` counts the work of a zoom.
std::optional<ViewedModel> look_at(std::shared_ptr<const AnalysedModel> model, std::optional<unsigned> steps,
                                   const ViewOptions& options, Diagnostics& diagnostics,
                                   const Control& control = no_control());

/// The detail that is asked for, with what the view makes of it: levels, and lengths in its own units.
DetailOptions resolved(DetailOptions asked, const ViewedModel& viewed);

} // namespace graftal
