#pragma once

#include <set>
#include <string>
#include <string_view>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// Reads strings and rules of Houdini. Their expressions become ours.
class HoudiniRules {
  public:
    /// `file` must outlive this.
    explicit HoudiniRules(const ForeignFile& file) : file_(file) {}

    /// The modules of a string, in whose expressions `names` have a meaning. `first`: before the first step.
    LSystemString string(std::string_view text, Span span, const std::set<std::string>& names, bool first);
    /// `[left <] symbol [> right] [: condition] = successor [: probability]`, as code. Reports what is wrong.
    LSystemProduction production(std::string_view text, Span span);

    /// Which of the values b, c and d expressions have used so far.
    const std::set<std::string>& values() const { return values_; }

  private:
    LSystemString formals(std::string_view text, Span span, std::set<std::string>& names,
                          std::string& condition);
    std::string expression(std::string_view text, Span span, const std::set<std::string>& names, bool first);

    const ForeignFile& file_;
    std::set<std::string> values_;
};

} // namespace graftal
