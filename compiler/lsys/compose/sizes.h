#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/lsys/compile/grammar.h"

namespace graftal {

/// What a parameter of a module means for what becomes of the module.
enum class ParameterRole : std::uint8_t {
    number, ///< anything
    length, ///< a size
    width,  ///< a size that reaches nothing but widths and diameters
};

/// What the first parameter of a symbol is to the turtle, if it is a size.
std::optional<ParameterRole> size_role(const LsysGrammar& grammar, SymbolId symbol);

/// Which parameters are sizes: multiplied by one factor, all sizes of a module make what becomes of it so
/// many times as large, and change nothing else: no choice of a production, no number, no angle. They are
/// those that expressions use in a homogeneous way, so that sizes come out of them as sizes (a dimensional
/// analysis of the productions, Buckingham 1914). What the productions draw at sizes of their own, `F` and
/// `F(2)`, is absolute: it stays as large as it is.
class LsysSizes {
  public:
    /// `inner`: of the models that have some, how many parameters come before their scale. The grammar must
    /// outlive this.
    LsysSizes(const LsysGrammar& grammar, std::map<SymbolId, std::size_t> inner);

    /// Whether a module that is rewritten has a size.
    bool any() const { return any_; }
    /// Of a module with so many parameters; empty where all are numbers.
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
