#pragma once

#include <string>

#include "compiler/editing/document.h"
#include "compiler/lower/lower_options.h"

namespace graftal {

/// The context in which a changed text is judged: as the command line would lower it.
struct EditContext {
    LowerOptions lower;
    LowerHelp help; ///< its control limits and ends the analysis
};

struct ContractionCheck {
    bool contracts = false; ///< proved, or nothing contains itself
    std::string why;        ///< it does not, or the text is at fault: as the command line says it
};

/// Whether the model of a text converges, by the analysis of all models (analysis/contraction.h). Throws
/// Cancelled and OutOfWork as the control of the context says.
ContractionCheck check_contraction(const std::string& name, std::string text, const EditContext& context);

/// The values of the `let` and `inner` statements of a file, those of `--set` in their place. What is at
/// fault has no value.
Environment lets_of(const Document& document, const LowerOptions& options = {});

} // namespace graftal
