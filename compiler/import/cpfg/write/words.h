#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// Writes the modules of a cpfg model as ours.
class CpfgWords {
  public:
    /// Both must outlive this.
    CpfgWords(CpfgNames& names, const LSystem& system);

    /// A string that productions go on to rewrite, or the homomorphism to draw.
    std::string text_of(const LSystemString& string, Span span) { return text_of(string, span, Use::word); }
    /// The successor of a homomorphism whose modules are drawn as they are.
    std::string drawn_text_of(const LSystemString& string, Span span) {
        return text_of(string, span, Use::drawn);
    }
    /// A predecessor or a context.
    std::string formals(const LSystemString& string);
    /// The module of ours that has this name in productions; "" for what has none.
    std::string name_of(const std::string& symbol);

    /// Number of times that the productions of a section are applied, each time to their results.
    int depth_of(LSystemSection section) const;

    // Features that the strings so far have used:
    const std::set<std::string>& declared() const { return declared_; } ///< names of modules to declare
    const std::set<char>& surfaces() const { return used_surfaces_; }
    bool uses_cut() const { return uses_cut_; }
    bool asks_environment() const { return asks_environment_; }
    bool bends_of_old() const { return bends_of_old_; }                 ///< by `_`
    const std::set<std::size_t>& tropisms() const { return tropisms_; } ///< their numbers
    /// Productions of `interpret` that draw modules which have other names here than where they are drawn.
    std::string stand_ins(Span span);
    bool has_stand_ins() const { return !stand_ins_.empty(); }

    static std::string surface_name(char letter);
    static constexpr const char* cut_name = "Cut";

  private:
    enum class Use { word, drawn };

    bool is_renamed(const std::string& symbol) const;
    void find_told();
    std::string name_in_dialect(const std::string& symbol) const;
    std::string text_of(const LSystemString& string, Span span, Use use);
    std::string text_of(const LSystemModule& module, Span span, Use use);
    std::string own_text_of(const LSystemModule& module, Span span, bool other_arity);
    std::string parameters(const LSystemModule& module, Span span, bool other_arity);
    std::string default_parameter(const std::string& symbol, Span span);
    std::string surface(const LSystemModule& module, Span span);
    std::string width(const LSystemModule& module, Span span);
    std::string elasticity(const LSystemModule& module, Span span);
    std::string directive(const LSystemModule& module, Span span);
    std::string tropism(const LSystemModule& module, Span span);
    std::string colour_step(const LSystemModule& module) const;
    std::string query(const LSystemModule& module, Span span);

    CpfgNames& names_;
    const LSystem& system_;
    using WithParameters = std::set<std::pair<std::string, std::size_t>>; ///< symbols, numbers of parameters
    std::set<std::string> mentioned_; ///< symbols that productions look at
    std::set<std::string> rewritten_; ///< symbols that begin a predecessor
    std::set<std::string> told_;      ///< symbols of a dialect that several of ours stand for
    bool has_long_names_ = false;     ///< so that names beside each other need blanks
    WithParameters drawn_otherwise_;  ///< symbols drawn by the homomorphism
    WithParameters stand_ins_;
    std::set<std::string> declared_;
    std::set<char> used_surfaces_;
    bool uses_cut_ = false, asks_environment_ = false, bends_of_old_ = false;
    std::set<std::size_t> tropisms_;
};

} // namespace graftal
