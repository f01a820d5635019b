#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// The statements of a block, whose braces may be missing; nothing after an error. Printing is left out.
std::optional<LSystemBlock> read_cpfg_block(std::string_view text, Span span, CpfgNames& names);

/// The block with its braces, on one line.
std::string cpfg_block_text(const LSystemBlock& block);

/// Calls `take` for all assignments of a block; `always`: none stands in a condition or a loop.
void each_assignment(const LSystemBlock& block,
                     const std::function<void(const LSystemAction& action, bool always)>& take);

/// Whether some name stands in a text for which `wanted` holds.
bool names_any(std::string_view text, const std::function<bool(std::string_view)>& wanted);

/// Whether a text of ours draws random numbers.
bool is_random(std::string_view text);

} // namespace graftal
