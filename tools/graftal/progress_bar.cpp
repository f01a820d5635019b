#include "tools/graftal/progress_bar.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "runtime/render/frame_clock.h"

namespace graftal {

namespace {

constexpr int bar_width = 40;

std::string bar(double fraction) {
    const int full = static_cast<int>(fraction * bar_width);
    return fmt::format("[{:<{}}] {:3.0f} %", std::string(static_cast<std::size_t>(full), '='), bar_width,
                       100 * fraction);
}

/// " 12 s left", " 3 min left"
std::string time_left(double seconds) {
    if (!(seconds >= 1)) return {};
    return seconds < 100 ? fmt::format(", {:.0f} s left", seconds)
                         : fmt::format(", {:.0f} min left", std::ceil(seconds / 60));
}

} // namespace

ProgressBar::ProgressBar(bool wanted)
    : wanted_(wanted), in_place_(::isatty(STDERR_FILENO)), told_(Clock::now()), begun_(told_) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::show(const std::string& text) {
    if (!wanted_ || text == shown_) return;
    if (in_place_) {
        std::fputs(("\r\033[K" + text).c_str(), stderr);
        std::fflush(stderr);
        shown_ = text;
        return;
    }
    const Clock::time_point now = Clock::now();
    if (now - told_ < time_between_lines) return;
    told_ = now;
    std::fputs(("graftal: " + text + "\n").c_str(), stderr);
}

void ProgressBar::say_at_once(const std::string& text) {
    told_ = Clock::now() - time_between_lines;
    show(text);
}

void ProgressBar::show(const std::string& what, double fraction, const std::string& more) {
    if (!(fraction >= fraction_)) { // another task begins
        begun_ = Clock::now();
        begun_at_ = fraction;
    }
    fraction_ = fraction;
    constexpr double enough_to_tell = 0.02;
    const double seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
    const double done = fraction - begun_at_;
    const std::string rest =
        more + (done >= enough_to_tell ? time_left(seconds * (1 - fraction) / done) : "");
    show(in_place_ ? fmt::format("{:<18}", what) + bar(fraction) + rest
                   : fmt::format("{}, {:.0f} %", what, 100 * fraction) + rest);
}

void ProgressBar::show(const DrawProgress& progress) {
    if (progress.fraction)
        show(std::string(progress.stage), *progress.fraction,
             progress.samples > 0 ? fmt::format(", {:.3g} samples", progress.samples) : "");
    else
        show(in_place_ ? fmt::format("{:<18}...", progress.stage) : std::string(progress.stage));
}

void ProgressBar::clear() {
    if (shown_.empty()) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    shown_.clear();
}

CancelFlag ShownTime::flag() {
    return CancelFlag(
        [this] {
            show();
            return asked_.raised();
        },
        asked_.wake_descriptor());
}

void ShownTime::show() {
    const auto now = static_cast<long>(watch_.seconds());
    if (now <= shown_ || !mutex_.try_lock()) return;
    const std::lock_guard lock(mutex_, std::adopt_lock);
    shown_ = now;
    bar_.show(fmt::format("{}, {}", what_, duration_text(static_cast<double>(now))));
}

} // namespace graftal
