#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"

// The text of a cpfg model before it is parsed: what the C preprocessor does with it, and its statements.

namespace graftal {

/// A macro of the text.
struct CpfgMacro {
    std::string name;
    std::optional<std::vector<std::string>> parameters; ///< nothing: without parentheses
    std::string body;
    Span span; ///< of the line
};

/// A line of the model, with those that continue it. Comments are taken out.
struct CpfgStatement {
    std::string text;                                   ///< line ends are spaces
    std::vector<std::uint32_t> places;                  ///< of each character in the file
    std::vector<std::pair<std::string, Span>> comments; ///< before it
};

struct CpfgSource {
    std::vector<CpfgMacro> macros; ///< in the order of the text; those that are defined at its end
    std::vector<CpfgStatement> statements;
};

/// Reports what is wrong, and gives nothing then. Files that the text includes are read beside it; places in
/// them are those of the `#include`.
std::optional<CpfgSource> read_cpfg_source(const ForeignFile& file);

/// The text with all macros written out that `chosen` accepts; nothing where that does not end, or takes too
/// much room.
std::optional<std::string> expand_cpfg_macros(std::string_view text, const std::vector<CpfgMacro>& macros,
                                              const std::function<bool(const CpfgMacro&)>& chosen);

} // namespace graftal
