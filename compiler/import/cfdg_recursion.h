#pragma once

#include <optional>
#include <vector>

#include "compiler/import/cfdg_ast.h"
#include "compiler/import/cfdg_expression.h"

namespace graftal::cfdg {

/// How the shapes of a grammar call each other.
class Recursion {
  public:
    Recursion(const Grammar& grammar, const Expressions& expressions);

    /// The generations after which recursion ends where it would not by itself: its sizes do not shrink, or
    /// its parameters change for ever. Nothing of a shape that needs no end.
    std::optional<int> limit(std::size_t shape) const { return limits_[component_[shape]]; }
    bool shrinks(std::size_t shape) const { return shrinks_[component_[shape]]; }
    /// Whether they lead to each other.
    bool together(std::size_t a, std::size_t b) const { return component_[a] == component_[b]; }
    std::optional<std::size_t> index(const std::string& shape) const;

  private:
    struct Call {
        std::size_t from = 0, to = 0;
        double growth = 0; ///< the logarithm of the factor of size, at most
        bool changes_parameters = false;
    };

    void walk(std::size_t from, const Elements& elements, double growth);
    void find_components();
    void find_limits();

    const Grammar& grammar_;
    const Expressions& expressions_;
    std::vector<Call> calls_;
    std::vector<std::size_t> component_;     ///< by shape
    std::vector<std::optional<int>> limits_; ///< by component
    std::vector<bool> shrinks_;
};

/// The logarithm of the largest factor of size; infinite if it cannot be known.
double growth_of(const Modification& modification, const Expressions& expressions);

} // namespace graftal::cfdg
