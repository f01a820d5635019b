#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "compiler/editing/maps/contraction_check.h"
#include "compiler/editing/positions.h"
#include "compiler/editing/text_edit.h"
#include "compiler/session/values.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

/// Whether an ask of this name is about the text alone: completion, hovering, names, layout, maps, settings,
/// variation.
bool is_about_text(const std::string& what);

/// The text that asks are about, and what is known of its model.
struct AskedText {
    const StudioState& state;                                ///< has a text
    const AnalysedModel* model = nullptr;                    ///< null: unknown, as of a text with errors
    const std::vector<ModelParameter>* parameters = nullptr; ///< likewise
    const EditContext& context;
};

/// The fields of the answer (docs/studio.md). Requires is_about_text(). Throws BadMessage, Cancelled and
/// OutOfWork.
nlohmann::json answer_about_text(const std::string& what, const nlohmann::json& ask, const AskedText& asked);

/// Edits of a text as the page counts them. `positions`: of that text.
nlohmann::json edits_json(const std::vector<TextEdit>& edits, const TextPositions& positions);

/// Adds `maps` and `digraphs` to the message `model` (docs/studio.md). Requires a state with a text.
void add_maps(nlohmann::json& message, const StudioState& state, const AnalysedModel& model);

} // namespace graftal
