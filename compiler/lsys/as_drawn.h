#pragma once

#include <memory>
#include <optional>
#include <string>

#include "compiler/lower/plant.h"
#include "compiler/lsys/drawing.h"

namespace graftal {

/// The word that draw_lsys() draws, as an axiom would have it, before interpretation. Nothing after an error:
/// of a limit, and of more than 5 million modules.
std::optional<std::string> word_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                         LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                         Diagnostics& diagnostics);

/// Its modules, and what each is drawn as; null after an error.
std::shared_ptr<const Plant> plant_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                            LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                            Diagnostics& diagnostics);

} // namespace graftal
