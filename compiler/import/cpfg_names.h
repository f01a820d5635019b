#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "compiler/import/cpfg_source.h"
#include "compiler/import/cpfg_view.h"
#include "compiler/import/importer.h"

namespace graftal {

bool is_cpfg_name(char c);

/// What the names of a cpfg model stand for: its macros and its functions. Reports what stands for nothing.
class CpfgNames {
  public:
    /// All must outlive this.
    CpfgNames(const ForeignFile& file, const CpfgSource& source, const CpfgView& view);

    const ForeignFile& file() const { return file_; }
    const CpfgSource& source() const { return source_; }
    const CpfgView& view() const { return view_; }

    void error(Span span, const std::string& message) { file_.diagnostics.error(span, message); }
    void warn_once(Span span, const std::string& message);

    /// Macros that are numbers stay names.
    const std::set<std::string>& lets() const { return lets_; }

    /// The text with its macros written out; `in_string`: those that stay names too.
    std::string expanded(std::string_view text, Span span, bool in_string);
    /// An expression in our language.
    std::string expression(std::string_view text, Span span);

    /// Places of the functions that expressions have used.
    const std::set<std::size_t>& used_tables() const { return used_tables_; }
    std::string table_name(std::size_t place) const { return view_.functions[place].name + "_of"; }

  private:
    void find_lets();
    std::optional<std::string> table_named(std::string_view id, Span span);

    const ForeignFile& file_;
    const CpfgSource& source_;
    const CpfgView& view_;
    std::set<std::string> lets_;
    std::set<std::string> warned_; ///< what was said
    std::set<std::size_t> used_tables_;
};

} // namespace graftal
