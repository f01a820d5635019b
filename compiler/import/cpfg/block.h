#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/cpfg/names.h"

namespace graftal {

/// A statement of a block, in our language.
struct CpfgAction {
    enum class Kind { assign, branch, loop, loop_after } kind = Kind::assign;
    std::string name;   ///< variable to assign
    std::string target; ///< variable with its indices
    std::string value;  ///< or the condition
    std::vector<CpfgAction> then, otherwise;
    bool has_otherwise = false;
};

using CpfgBlock = std::vector<CpfgAction>;

/// The statements of a block, whose braces may be missing; nothing after an error. Printing is left out.
std::optional<CpfgBlock> read_cpfg_block(std::string_view text, Span span, CpfgNames& names);

/// The block with its braces, on one line.
std::string cpfg_block_text(const CpfgBlock& block);

/// Calls `take` for all assignments of a block; `always`: none stands in a condition or a loop.
void each_assignment(const CpfgBlock& block,
                     const std::function<void(const CpfgAction& action, bool always)>& take);

/// Whether some name stands in a text for which `wanted` holds.
bool names_any(std::string_view text, const std::function<bool(std::string_view)>& wanted);

/// Whether a text of ours draws random numbers.
bool is_random(std::string_view text);

} // namespace graftal
