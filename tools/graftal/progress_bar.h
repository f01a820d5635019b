#pragma once

#include <chrono>
#include <string>

#include "runtime/render/render.h"

namespace graftal {

/// One line on standard error that is rewritten in place, if that is a terminal; else a new line every ten
/// seconds.
class ProgressBar {
  public:
    explicit ProgressBar(bool wanted);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Names what is going on, without a measure of it.
    void show(const std::string& text);
    /// Shows a share, and the time that is left, by the time that it took to come so far.
    void show(const std::string& what, double fraction, const std::string& more = "");
    void show(const DrawProgress& progress);
    /// Takes the line away, so that other text can be printed.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds time_between_lines{10};

    bool wanted_, in_place_;
    Clock::time_point told_;  ///< the last line that is not rewritten, or the beginning
    Clock::time_point begun_; ///< the task that fraction_ is of, at begun_at_
    double fraction_ = 1, begun_at_ = 0;
    std::string shown_;
};

} // namespace graftal
