#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "compiler/session/session.h"
#include "compiler/session/shared_framing.h"

namespace graftal {

struct StudioState;

/// Throws BadMessage unless this is a film as docs/studio.md has it.
void check_film(const nlohmann::json& film);

/// The framing of a film, found from some of its frames; kept while film and model stay.
class FilmFraming {
  public:
    /// `state` has a film and a text. Null where no moment has a model, and where the session is cancelled.
    std::shared_ptr<const SharedFraming> of(const StudioState& state, Session& session);

  private:
    std::string known_; ///< what it was made from
    std::shared_ptr<const SharedFraming> framing_;
};

} // namespace graftal
