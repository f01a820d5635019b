#pragma once

#include <map>
#include <optional>
#include <vector>

#include "compiler/import/cfdg/evaluate/expression.h"
#include "compiler/import/cfdg/parse/ast.h"

namespace graftal::cfdg {

/// The calls between the shapes of a grammar.
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
    /// Whether the shape leads back to itself.
    bool recurs(std::size_t shape) const { return recurs_[component_[shape]]; }
    /// Whether what is too small to be seen one by one is seen together, below the shape: recursion whose
    /// areas fill the picture, or that shrinks slowly and begins anew at all sizes.
    bool fades_slowly(std::size_t from) const;
    /// The shapes of the grammar, those that others call before these.
    std::vector<std::size_t> from_the_leaves() const;
    /// Marks all shapes that lead to a marked one.
    void mark_callers(std::vector<bool>& marked) const;

  private:
    struct Call {
        std::size_t from = 0, to = 0;
        double growth = 0; ///< the logarithm of the factor of size, at most
        bool changes_parameters = false;
    };

    void call_passed();
    void call(std::size_t from, std::size_t to, const Element& element, double growth);
    double growth_of_transform(const Element& element) const;
    void walk(std::size_t from, const Elements& elements, double growth);
    void find_components();
    void find_limits();
    static bool fills(const std::vector<const Call*>& calls, const std::map<std::size_t, std::size_t>& place);

    const Grammar& grammar_;
    const Expressions& expressions_;
    std::vector<Call> calls_; ///< the number behind those of the shapes is any shape that an expression names
    std::vector<std::size_t> component_;     ///< by shape
    std::vector<std::optional<int>> limits_; ///< by component
    std::vector<bool> shrinks_, recurs_, slow_, branches_;
};

/// The logarithm of the largest factor of size; infinite if it cannot be known.
double growth_of(const Modification& modification, const Expressions& expressions);

} // namespace graftal::cfdg
