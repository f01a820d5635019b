#pragma once

#include "compiler/support/control.h"

namespace graftal {

/// Remembers SIGINT, SIGTERM and SIGHUP while one of these lives: they do not end the process. So temporary
/// files can be removed and children stopped. May be nested; the last one to go restores the previous
/// handling.
class Interruption {
  public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// The last signal caught since the outermost one began, or 0.
    int signal() const;
    /// Raised by such a signal. To be asked while this lives.
    CancelFlag flag() const;
};

} // namespace graftal
