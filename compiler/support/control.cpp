#include "compiler/support/control.h"

namespace graftal {

const Control& no_control() {
    static const Control none;
    return none;
}

void WorkMeter::look() {
    if (control_.cancel.raised()) throw Cancelled();
    next_ = progress_.done + interval_;
    if (control_.on_progress) control_.on_progress(progress_);
}

} // namespace graftal
