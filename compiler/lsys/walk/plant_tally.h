#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lower/plant_sums.h"
#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/turtle/witness.h"

namespace graftal {

/// Sums up a plant part by part, as it is composed, with the rows that PlantBuilder would make of it: the
/// sums of a part are taken once, and added wherever it stands. So totals of 10^30 modules take O(parts).
class PlantTally : public WordWitness {
  public:
    /// The grammar must outlive this. `steps`: of the derivation.
    PlantTally(const LsysGrammar& grammar, double steps) : grammar_(grammar), steps_(steps) { opens_part(); }

    PlantTotals totals() const;

    bool sums() const override { return true; }
    /// False, without an error, where the parts have more sums than there is memory or work for.
    bool begins(const Module& module, const Turtle& turtle) override;
    void opens_part() override { open_.emplace_back().axes.emplace_back(); }
    std::uint32_t closes_part() override;
    bool places(std::uint32_t part, double scale) override;
    void ends(const Turtle& turtle) override;
    void runs(SymbolId symbol, std::span<const double> parameters, const Turtle& turtle) override;
    void draws(const DrawnBody& body) override;
    void opens_branch() override;
    void closes_branch() override;

  private:
    /// Whether a branch that begins here leaves its axis, and so is of the next order: no other has just
    /// begun here. What came before a part is not known while it is summed up.
    enum class Leaves : std::uint8_t { as_before, no, yes };

    struct Axis {
        std::uint32_t order = 0; ///< counted from that of the part's first axis
        bool one_more = false;   ///< where a branch at the part's start leaves its axis
        Leaves leaves = Leaves::as_before;
    };

    struct Key {
        std::uint32_t order = 0;
        bool one_more = false;
        SymbolId name = 0;
        std::uint16_t material = 0;

        auto operator<=>(const Key&) const = default;
    };
    struct Sums : PlantSums {
        BigCount balls = 0, unmeasured = 0;
    };

    /// A part, done or under way.
    struct Part {
        std::map<Key, Sums> sums;
        std::vector<Axis> axes;        ///< of the branches under way; the last is the turtle's
        std::optional<SymbolId> whole; ///< the module of the word in whose place others are drawn now
        std::size_t whole_depth = 0;   ///< of axes where it began
    };

    static constexpr std::uint16_t no_organ = UINT16_MAX, own_material = UINT16_MAX - 1;

    Part& part() { return open_.back(); }
    Axis& axis() { return open_.back().axes.back(); }
    Sums& add_row(SymbolId name, std::uint16_t material);

    const LsysGrammar& grammar_;
    double steps_;
    std::vector<Part> parts_;
    std::size_t sum_count_ = 0;      ///< of parts_
    std::size_t addition_count_ = 0; ///< of those sums to others
    std::vector<Part> open_;         ///< those under way; the first is the whole word
    std::vector<std::string> materials_;
    SymbolId running_ = 0; ///< the module that the turtle carries out
};

/// Whether a module is a part of the plant where others are drawn in its place.
bool is_plant_part(TurtleCommand command);

/// The number of a material among those that are drawn, which takes it up where it is new.
std::uint16_t number_of_material(std::vector<std::string>& materials, std::string_view name);

} // namespace graftal
