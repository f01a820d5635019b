#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/text_edit.h"

namespace graftal {

/// The settings that `--steps` and `--seed` choose, and that a text may choose as well.
enum class ModelSetting : std::uint8_t { steps, seed };

struct SettingChange {
    std::vector<TextEdit> edits; ///< empty where it is refused
    std::string refusal;         ///< why the text cannot say it, as a sentence; "": it can
    std::string remark;          ///< what the text cannot say of it, likewise
};

/// Has the text choose what `--steps` or `--seed` with this value chooses. The number of the text is
/// replaced; where it has none, a line is added. Of an L-system the steps are those of the main block, and
/// the seed is that of each block with chance. Models that are used keep their own seeds.
SettingChange write_setting(const Document& document, ModelSetting setting, std::uint64_t value);

} // namespace graftal
