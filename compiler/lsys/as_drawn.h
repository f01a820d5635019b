#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "compiler/lower/plant.h"
#include "compiler/lower/plant_sums.h"
#include "compiler/lsys/drawing.h"

namespace graftal {

/// Most modules of a word or a plant that is told one by one.
inline constexpr std::uint64_t most_told_modules = 5'000'000;

/// The word that draw_lsys() draws, as an axiom would have it, before interpretation. Nothing after an error:
/// of a limit, and of more than most_told_modules.
std::optional<std::string> word_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                         LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                         Diagnostics& diagnostics);

/// Its modules, and what each is drawn as; null after an error.
std::shared_ptr<const Plant> plant_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                            LsysDrawOptions options, Graph& graph, ObjectPool& pool,
                                            Diagnostics& diagnostics);

/// Totals over all modules, of which there may be any number. Null, perhaps without an error, where the word
/// must be derived module by module, or hardly repeats. O(parts).
std::shared_ptr<const PlantTotals> totals_as_drawn(const LsysGrammar& grammar, const ModelPlacer& models,
                                                   const LsysDrawOptions& options, Graph& graph,
                                                   ObjectPool& pool, Diagnostics& diagnostics);

} // namespace graftal
