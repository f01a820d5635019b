#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/lsys/compile/grammar.h"

namespace graftal {

/// The effect of a parameter of a module on what the module becomes.
enum class ParameterRole : std::uint8_t {
    number, ///< anything
    length, ///< a size
    width,  ///< a size that reaches nothing but widths and diameters
};

/// The role for the turtle of a symbol's first parameter, if that is a size.
std::optional<ParameterRole> size_role(const LsysGrammar& grammar, SymbolId symbol);

/// The parameters that are sizes. One factor on all sizes of a module makes its figure as many times as
/// large. It changes nothing else: no choice of a production, no number, no angle. Expressions use sizes in
/// a homogeneous way, so that sizes come out as sizes (a dimensional analysis of the productions, Buckingham
/// 1914). A size that a production writes itself, `F` or `F(2)`, is absolute and stays.
class LsysSizes {
  public:
    /// `inner`: number of parameters before the scale, of the models that have inner ones. The grammar must
    /// outlive this.
    LsysSizes(const LsysGrammar& grammar, std::map<SymbolId, std::size_t> inner);

    /// Whether a module that is rewritten has a size.
    bool any() const { return any_; }
    /// The roles of the parameters of a module with this arity; empty where all are numbers.
    std::span<const ParameterRole> roles(SymbolId symbol, std::size_t arity) const;
    /// Whether a model is placed with a scale of its own.
    bool gives_scale(SymbolId model, std::size_t arity) const;
    /// Whether a module of a successor has sizes, of which none came from the predecessor.
    bool is_absolute(const LsysRule& rule, std::size_t module) const;

  private:
    class Inference;

    bool any_ = false;
    std::map<std::pair<SymbolId, std::size_t>, std::vector<ParameterRole>> roles_;
    std::vector<std::vector<bool>> absolute_; ///< by rule, by module of its successor
    const LsysRule* rules_;                   ///< of the grammar, the first
    std::map<SymbolId, std::size_t> inner_;
};

} // namespace graftal
