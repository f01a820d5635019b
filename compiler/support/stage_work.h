#pragma once

#include <exception>
#include <limits>
#include <string>
#include <string_view>

namespace graftal {

/// The work of the stages of one model, counted and priced (stage_price.h), and its limit.
class StageWork {
  public:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();

    /// `spent_seconds`: by stages before. `kept_seconds`: what left() keeps back for stages to come.
    explicit StageWork(double limit_seconds = unlimited, double spent_seconds = 0, double kept_seconds = 0)
        : limit_(limit_seconds), kept_(kept_seconds), seconds_(spent_seconds) {}

    /// Throws OutOfWork where that goes beyond the limit.
    void add(std::string_view stage, double seconds);
    /// Adds the work of a stage that is done, without a limit.
    void settle(double seconds) { seconds_ += seconds; }

    double limit() const { return limit_; }
    double seconds() const { return seconds_; }
    /// The seconds until the limit.
    double left_in_all() const { return limit_ > seconds_ ? limit_ - seconds_ : 0; }
    /// Seconds left without those that are kept, for stages that can do with less.
    double left() const { return limit_ > kept_ + seconds_ ? limit_ - kept_ - seconds_ : 0; }

  private:
    double limit_, kept_;
    double seconds_;
};

/// Thrown by a stage that would take more work than is allowed: it leaves nothing behind. Session makes an
/// error of it.
class OutOfWork : public std::exception {
  public:
    OutOfWork(std::string_view stage, double limit_seconds);

    const std::string& stage() const { return stage_; }
    double limit_seconds() const { return limit_seconds_; }
    const char* what() const noexcept override { return "out of work"; }

  private:
    std::string stage_;
    double limit_seconds_;
};

} // namespace graftal
