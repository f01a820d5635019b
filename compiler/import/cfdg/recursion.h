#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compiler/import/cfdg/evaluate/expression.h"
#include "compiler/import/cfdg/parse/ast.h"

namespace graftal::cfdg {

/// The calls between the shapes of a grammar.
class Recursion {
  public:
    Recursion(const Grammar& grammar, Expressions& expressions);

    bool shrinks(std::size_t shape) const { return shrinks_[component_[shape]]; }
    /// Whether they lead to each other.
    bool together(std::size_t a, std::size_t b) const { return component_[a] == component_[b]; }
    /// Whether the shape leads back to itself.
    bool recurs(std::size_t shape) const { return recurs_[component_[shape]]; }
    /// Whether the shape leads to recursion, all of which shrinks, draws the same at each size, and fades:
    /// shapes that are too small to be seen one by one are not seen together either. This does not hold for
    /// recursion whose areas fill the picture, or that shrinks slowly and begins anew at all sizes.
    bool is_endless(std::size_t from) const;
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
    double growth_of_transform(const Element& element, const std::string& space);
    void walk(std::size_t from, const Elements& elements, double growth);
    void find_rates();
    static bool fills(const std::vector<const Call*>& calls, const std::map<std::size_t, std::size_t>& place);

    const Grammar& grammar_;
    Expressions& expressions_;
    std::vector<Call> calls_; ///< the number behind those of the shapes is any shape that an expression names
    std::vector<std::uint32_t> component_;                           ///< by shape
    std::vector<bool> shrinks_, recurs_, slow_, branches_, changes_; ///< by component
};

} // namespace graftal::cfdg
