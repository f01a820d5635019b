#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "compiler/session/session.h"
#include "compiler/session/shared_framing.h"
#include "compiler/session/stage_options.h"

namespace graftal {

/// The framing of a film, found from some of its frames; kept while film and model stay.
class FilmFraming {
  public:
    /// `film`: as docs/studio.md has it. `stages` may be those of any moment of it. Null where no moment has
    /// a model, and where the session is cancelled. Throws BadMessage.
    std::shared_ptr<const SharedFraming> of(const nlohmann::json& film, const std::string& text,
                                            StageOptions stages, Session& session);

  private:
    std::string known_; ///< what it was made from
    std::shared_ptr<const SharedFraming> framing_;
};

} // namespace graftal
