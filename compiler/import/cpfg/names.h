#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/cpfg/source.h"
#include "compiler/import/cpfg/view.h"
#include "compiler/import/importer.h"

namespace graftal {

struct CpfgDialect;

/// The meanings of the names of a cpfg model: its macros and its functions. Reports names without a meaning.
class CpfgNames {
  public:
    /// All must outlive this. `dialect`: of another program, whose expressions are ours already; null:
    /// cpfg's.
    CpfgNames(const ForeignFile& file, const CpfgSource& source, const CpfgView& view,
              const CpfgDialect* dialect = nullptr);

    const ForeignFile& file() const { return file_; }
    const CpfgSource& source() const { return source_; }
    const CpfgView& view() const { return view_; }
    const CpfgDialect* dialect() const { return dialect_; }

    void error(Span span, const std::string& message) { file_.diagnostics.error(span, message); }
    void warn_once(Span span, const std::string& message);

    /// Macros that are numbers stay names.
    const std::set<std::string>& lets() const { return lets_; }

    /// A variable's name here: `step` and `age` have a meaning in ours.
    std::string own_name(std::string_view name) const;
    /// The text with its macros written out; `in_string`: those that stay names too.
    std::string expanded(std::string_view text, Span span, bool in_string);
    /// An expression in our language.
    std::string expression(std::string_view text, Span span);

    /// The tables that expressions have used, in this order.
    const std::vector<CpfgFunction>& tables() const { return tables_; }

  private:
    void find_lets();
    void find_renamed();
    std::string with_own_names(std::string text) const;
    std::optional<std::string> call(std::string_view name, std::span<const std::string_view> arguments,
                                    std::span<const std::string> written, Span span);
    std::string table(std::string name, std::vector<double> values);
    std::optional<std::size_t> place_named(std::string_view id, std::size_t count, Span span);
    const CpfgFunction* function_named(std::string_view id, Span span);
    const CpfgViewCurve* curve_named(std::string_view id, Span span);
    std::string beta(std::span<const std::string_view> arguments, Span span);

    const ForeignFile& file_;
    const CpfgSource& source_;
    const CpfgView& view_;
    const CpfgDialect* dialect_;
    std::set<std::string> lets_;
    std::set<std::string> renamed_; ///< variables of the model
    std::set<std::string> warned_;  ///< warnings given
    std::vector<CpfgFunction> tables_;
};

} // namespace graftal
