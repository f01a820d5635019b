#pragma once

#include <deque>
#include <optional>
#include <string>

namespace graftal {

/// Guesses how long the frames that are left will take, from the last few.
class FrameClock {
  public:
    void add(double seconds);
    /// Nothing before the first frame.
    std::optional<double> seconds_left(std::size_t frames) const;

  private:
    std::deque<double> recent_;
};

/// "40 s", "1 min 12 s", "3 h 5 min"
std::string duration_text(double seconds);

} // namespace graftal
