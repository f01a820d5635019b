#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/lower/plant.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/turtle/turtle.h"
#include "compiler/lsys/turtle/witness.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// Takes the plant from a word that is drawn: a row for each letter that means nothing to the turtle, for
/// each module that others are drawn in the place of, and for each body. Moves, turns and widths have none.
/// Lines of polygons have none either: the polygon has, where it is closed.
class PlantBuilder : public WordWitness {
  public:
    /// Both must outlive this. `steps`: of the derivation, with the share of the next that has passed. More
    /// rows are an error.
    PlantBuilder(const LsysGrammar& grammar, double steps, std::uint64_t most_rows, Diagnostics& diagnostics)
        : grammar_(grammar), most_rows_(most_rows), diagnostics_(diagnostics) {
        plant_.steps = steps;
    }

    Plant take() && { return std::move(plant_); }

    bool begins(const Module& module, const Turtle& turtle) override;
    void ends(const Turtle& turtle) override;
    void runs(SymbolId symbol, std::span<const double> parameters, const Turtle& turtle) override;
    bool has_run(const Turtle& turtle) override;
    void draws(const DrawnBody& body) override;
    void opens_branch() override;
    void closes_branch() override;

  private:
    /// The axis that the turtle is on.
    struct Axis {
        std::uint32_t last = PlantModule::none; ///< module on it, or the one that it leaves
        bool begins = false;                    ///< nothing stands on it yet
        std::uint32_t order = 0, next_rank = 0;
    };

    bool has_room();
    PlantModule row(SymbolId symbol, std::span<const double> parameters, const Turtle& turtle);
    void add_blade(const DrawnBody& body);
    std::uint32_t shape_of(const Graph& graph, ObjectId model);
    void add(PlantModule row);
    void end(PlantModule& row, const Turtle& turtle) const;
    std::uint16_t name_of_symbol(SymbolId symbol);

    const LsysGrammar& grammar_;
    std::uint64_t most_rows_;
    Diagnostics& diagnostics_;
    Plant plant_;
    std::unordered_map<SymbolId, std::uint16_t> names_;
    std::unordered_map<ObjectId, std::uint32_t> shapes_; ///< of models
    std::vector<double> half_thicknesses_;               ///< by shape, in its own frame
    Axis axis_;
    std::vector<Axis> axes_; ///< of the branches under way
    // The module of the word under way:
    double age_ = -1;
    std::uint32_t whole_ = PlantModule::none; ///< its row, where others are drawn in its place
    std::size_t whole_depth_ = 0;             ///< of axes_ where it began
    PlantModule next_;                        ///< a row for what is run now
    std::size_t first_ = 0;                   ///< of the rows that it has made
    std::vector<PlantModule> polygons_;       ///< that are open, where they began
};

} // namespace graftal
