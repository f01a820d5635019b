#pragma once

#include <set>
#include <string>

#include "compiler/import/cpfg_names.h"
#include "compiler/import/cpfg_system.h"

namespace graftal {

/// Writes the modules of a cpfg model as ours.
class CpfgWords {
  public:
    /// Both must outlive this.
    CpfgWords(CpfgNames& names, const CpfgSystem& system) : names_(names), system_(system) {}

    /// `raw`: no module of the string is drawn as another one.
    std::string text_of(const CpfgString& string, Span span, bool raw = false);
    /// The same for a predecessor or a context.
    std::string formals(const CpfgString& string);
    /// The module of ours that has this name in productions.
    std::string name_of(const std::string& symbol);

    /// How often the productions of a section are applied to what they give.
    int depth_of(CpfgSection section) const;

    // What the strings so far have used:
    const std::set<std::string>& declared() const { return declared_; } ///< names of modules to declare
    const std::set<char>& surfaces() const { return used_surfaces_; }

    static std::string surface_name(char letter);

  private:
    bool has_production(const std::string& symbol) const;
    bool is_drawn_otherwise(const CpfgModule& module) const;
    std::string parameters(const CpfgModule& module, Span span, bool raw);
    std::string default_parameter(const std::string& symbol, Span span);
    std::string text_of(const CpfgModule& module, Span span, bool raw);
    std::string surface(const CpfgModule& module, Span span);
    std::string width(const CpfgModule& module, Span span);
    std::string directive(const CpfgModule& module, Span span);

    CpfgNames& names_;
    const CpfgSystem& system_;
    std::set<std::string> declared_;
    std::set<char> used_surfaces_;
};

} // namespace graftal
