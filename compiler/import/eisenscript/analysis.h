#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/import/eisenscript/parser.h"
#include "compiler/support/affine.h"

namespace graftal::eisenscript {

/// The rules of one name, of which chance takes one. It becomes one object.
struct Group {
    std::string name;               ///< in small letters
    std::vector<std::size_t> rules; ///< in Script::rules
    std::size_t component = 0;      ///< groups that lead to each other
    bool recurs = false;
    std::vector<std::size_t> counters; ///< rules of its component with a depth, whose counts it must know
    bool endless = false;              ///< it leads to recursion
    std::size_t height = 0;            ///< generations that it takes to its end, where it is not endless
};

/// The limits that end the growth of a script.
struct Limits {
    int generations = 1000; ///< maxdepth
    double objects = 100'000;
    std::optional<double> least_size, most_size; ///< of the cube's diagonal
};

/// The map of the operators of a loop, about the middle of the unit cube.
Affine map_of(const Loop& loop);
/// The factor by which a loop makes the diagonal of the cube longer.
double growth_of(const Loop& loop);

/// The groups of a script, and how they call each other. Requires that the script has no error.
class Analysis {
  public:
    /// Counts that an object may have as parameters.
    static constexpr std::size_t most_counters = 98;

    /// Must outlive this.
    Analysis(const Script& script, const Limits& limits);

    const std::vector<Group>& groups() const { return groups_; }
    /// Null of primitives.
    const Group* group(const std::string& name) const;
    /// A group whose rules lead to more depths of their own than `most_counters`; null of none. Then nothing
    /// is counted.
    const Group* too_deep() const;
    /// Index of the group of a rule.
    std::size_t group_of(std::size_t rule) const { return group_of_rule_[rule]; }

    /// The generations that Structure Synth makes, or nothing if the script ends by itself. It stops after
    /// the one that reaches the number of objects; with chances, where their mean does.
    std::optional<int> generations() const { return generations_; }
    bool by_objects() const { return by_objects_; }
    /// Whether the count took too much work, and stopped before Structure Synth would.
    bool gave_up() const { return gave_up_; }
    /// Cubes and other primitives that it then has drawn; with chances, their mean.
    double objects() const { return objects_; }

  private:
    Components find_components();
    void find_heights(const Components& components);
    void count();

    const Script& script_;
    const Limits& limits_;
    std::vector<Group> groups_;
    std::map<std::string, std::size_t> by_name_;
    std::vector<std::size_t> group_of_rule_;
    std::optional<int> generations_;
    bool by_objects_ = false;
    bool gave_up_ = false;
    double objects_ = 0;
};

} // namespace graftal::eisenscript
