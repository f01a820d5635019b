#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/derivation.h"
#include "compiler/lower/object_pool.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/lsys/turtle/witness.h"
#include "compiler/support/control.h"

namespace graftal {

struct LsysDrawOptions {
    std::optional<unsigned> steps; ///< nothing: infinitely many
    double share = 0;              ///< of the step after these that has passed: ages are larger by so much
    std::uint64_t seed = 0;
    /// Derive the word, as contexts are anyway, rather than compose parts; random numbers are drawn for each
    /// module, rather than from a pool.
    bool exact = false;
    std::uint64_t max_modules = 50'000'000; ///< of the word
    /// Number of parameters before the scale, of each model that has inner ones.
    std::map<SymbolId, std::size_t> inner;
    bool has_other_models = false; ///< one is no primitive of finite size
    std::size_t max_parts = 1'000'000;
    std::uint64_t run_from = 4096; ///< words of so many modules are drawn into a run, if they repeat little
    WorkMeter* meter = nullptr;    ///< counts modules, each time that one is looked at; null: nobody does
};

struct LsysDrawing {
    std::vector<Instance> instances; ///< the whole model, in world space
    PackedEdges packed;              ///< more of it
    Derivation derivation;
    bool limited_by_work = false; ///< with more work allowed it would be another
};

/// Draws what a grammar derives into `graph`. A derived word is composed of its pieces, each drawn once,
/// where they repeat. Where little does, its round bodies go into a run (graph/run.h). `models` places
/// models there; `pool` makes the objects. Nothing after an error.
///
/// Random parts have as many variants as keep the drift below 5 %: the relative standard error of the mean
/// number of segments over a pool. The theory for independent samples gives it (nu_n = n nu / K, nu the
/// relative variance of one level); stratified ones stray less.
///
/// Where sizes, or directions, make too many parts, those that differ by little are taken for equal, by as
/// little as suffices: Derivation::error bounds the displacement.
std::optional<LsysDrawing> draw_lsys(const LsysGrammar& grammar, const ModelPlacer& models,
                                     const LsysDrawOptions& options, Graph& graph, ObjectPool& pool,
                                     Diagnostics& diagnostics);

/// Has a witness hear of the word that draw_lsys() draws, by the same choices of chance, and of its bodies,
/// as thick as it draws them. False after an error, or where a witness sums up parts that hardly
/// repeat. Requires steps. O(modules that are drawn), or of parts.
bool tell_lsys(const LsysGrammar& grammar, const ModelPlacer& models, const LsysDrawOptions& options,
               Graph& graph, ObjectPool& pool, Diagnostics& diagnostics, WordWitness& witness);

} // namespace graftal
