#include "tools/graftal/progress_bar.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace graftal {

namespace {

constexpr int bar_width = 40;

std::string bar(double fraction) {
    const int full = static_cast<int>(fraction * bar_width);
    return fmt::format("[{:<{}}] {:3.0f} %", std::string(static_cast<std::size_t>(full), '='), bar_width,
                       100 * fraction);
}

} // namespace

ProgressBar::ProgressBar(bool wanted) : enabled_(wanted && ::isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::show(const std::string& text) {
    if (!enabled_ || text == shown_) return;
    std::fputs(("\r\033[K" + text).c_str(), stderr);
    std::fflush(stderr);
    shown_ = text;
}

void ProgressBar::show(const std::string& what, double fraction) {
    show(fmt::format("{:<18}", what) + bar(fraction));
}

void ProgressBar::show(const DrawProgress& progress) {
    if (progress.fraction)
        show(std::string(progress.stage), *progress.fraction);
    else
        show(fmt::format("{:<18}...", progress.stage));
}

void ProgressBar::clear() {
    if (shown_.empty()) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    shown_.clear();
}

} // namespace graftal
