#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "compiler/support/control.h"
#include "runtime/render/render.h"
#include "runtime/render/stopwatch.h"

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
    /// Does the same, and writes a line without the ten seconds.
    void say_at_once(const std::string& text);
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

/// Whoever does long work asks whether it is to end: meanwhile this shows how long it has taken.
class ShownTime {
  public:
    /// `what` is going on, until `asked` ends it. The bar must outlive this, and this all copies of flag().
    ShownTime(ProgressBar& bar, std::string what, CancelFlag asked)
        : bar_(bar), what_(std::move(what)), asked_(std::move(asked)) {}
    CancelFlag flag();

  private:
    void show();

    ProgressBar& bar_;
    std::string what_;
    CancelFlag asked_;
    Stopwatch watch_;
    std::mutex mutex_; ///< of the bar
    std::atomic<long> shown_ = 0;
};

} // namespace graftal
