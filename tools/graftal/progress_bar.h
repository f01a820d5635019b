#pragma once

#include <string>

#include "runtime/render/render.h"

namespace graftal {

/// One line on standard error that is rewritten in place, if that is a terminal; else nothing at all.
class ProgressBar {
  public:
    explicit ProgressBar(bool wanted);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Names what is going on, without a measure of it.
    void show(const std::string& text);
    void show(const std::string& what, double fraction);
    void show(const DrawProgress& progress);
    /// Takes the line away, so that other text can be printed.
    void clear();

  private:
    bool enabled_;
    std::string shown_;
};

} // namespace graftal
