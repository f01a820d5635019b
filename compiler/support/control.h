#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string_view>
#include <utility>

#include "compiler/support/stage_work.h"

namespace graftal {

/// Whether somebody wants long work to end early. Copies ask the same; one made from nothing is never raised.
class CancelFlag {
  public:
    CancelFlag() = default;
    /// `asked` is called often, by many threads at once. `wake_descriptor`: a file descriptor that becomes
    /// readable when the flag is raised, for callers that wait for a child process; -1: they ask now and
    /// then.
    explicit CancelFlag(std::function<bool()> asked, int wake_descriptor = -1)
        : asked_(std::move(asked)), wake_descriptor_(wake_descriptor) {}

    bool raised() const { return asked_ && asked_(); }
    int wake_descriptor() const { return wake_descriptor_; }

  private:
    std::function<bool()> asked_;
    int wake_descriptor_ = -1;
};

/// The progress of a long stage.
struct Progress {
    std::string_view stage;  ///< as `--time` names it
    std::uint64_t done = 0;  ///< in units of the stage's own
    std::uint64_t total = 0; ///< 0: nobody knows
};

/// The hooks by which a caller ends a long stage early, and hears of it.
struct Control {
    CancelFlag cancel;
    std::function<void(const Progress&)> on_progress; ///< by the thread that runs the stage
    StageWork* work = nullptr; ///< work of stages before a picture; null: nobody counts
};

/// The control of callers that neither cancel nor listen.
const Control& no_control();

/// Thrown by a stage that was cancelled: it leaves nothing behind. Session catches it.
class Cancelled : public std::exception {
  public:
    const char* what() const noexcept override { return "cancelled"; }
};

/// Counts the work of a stage. After every `interval` units it asks the flag, and throws Cancelled if that is
/// raised; else it charges the work so far (OutOfWork), and tells the progress. So a stage ends within one
/// interval of being cancelled.
class WorkMeter {
  public:
    /// Keeps a reference to the control, and the stage's name. `price`: of a unit, in seconds
    /// (stage_price.h).
    WorkMeter(const Control& control, std::string_view stage, std::uint64_t interval, double price = 0)
        : control_(control), progress_{stage, 0, 0}, interval_(interval), price_(price) {}
    WorkMeter(const WorkMeter&) = delete;
    WorkMeter& operator=(const WorkMeter&) = delete;
    ~WorkMeter() {
        if (control_.work) control_.work->settle(owed_);
    }

    void add(std::uint64_t units = 1) { add(units, price_); }
    /// Units that cost as much as this each.
    void add(std::uint64_t units, double price) {
        owed_ += static_cast<double>(units) * price;
        progress_.done += units;
        if (progress_.done >= next_) look();
    }
    /// Work that is known before it is done, and that no progress is told of.
    void charge(double seconds);

    /// The seconds of work that are left. Infinite: there is no limit.
    double left() const { return control_.work ? control_.work->left() - owed_ : StageWork::unlimited; }
    /// The seconds until the limit, those that are kept for later stages too.
    double left_in_all() const {
        return control_.work ? control_.work->left_in_all() - owed_ : StageWork::unlimited;
    }

  private:
    void look();

    const Control& control_;
    Progress progress_;
    std::uint64_t interval_;
    double price_;
    double owed_ = 0;        ///< not yet charged
    std::uint64_t next_ = 0; ///< the first unit is looked at: what is cancelled already does not begin
};

} // namespace graftal
