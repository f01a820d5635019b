#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/inverse/map_fit.h"
#include "runtime/inverse/target_frame.h"
#include "runtime/studio/text_asks.h"

namespace graftal {

/// The ask `fit` (docs/studio.md): moves the maps of a text until their attractor is a target, piece by
/// piece.
class TextFit {
  public:
    /// Throws BadMessage where the target is none, the maps cannot be moved, or they do not meet the target.
    TextFit(const nlohmann::json& ask, const AskedText& asked);

    /// MapFit::step().
    bool step(const Workers& workers, const CancelFlag& cancel) { return fit_->step(workers, cancel); }
    double share() const { return fit_->fraction(); }

    /// Whether the state has the text and the numbers that this began with.
    bool is_about(const StudioState& state) const;

    /// The fields of the answer: the edits that write the best maps so far, and how they agree. Requires the
    /// text that this began with. Throws as answer_about_text().
    nlohmann::json answer(const AskedText& asked) const;

  private:
    struct NamedMap {
        std::string name;
        Affine matrix;
    };

    StudioState state_;
    std::vector<NamedMap> maps_; ///< in the order of the fit's
    std::unique_ptr<Target> target_;
    std::unique_ptr<TargetFrame> frame_;
    std::unique_ptr<MapFit> fit_;
    SetAgreement before_;
};

} // namespace graftal
