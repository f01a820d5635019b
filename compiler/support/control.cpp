#include "compiler/support/control.h"

namespace graftal {

const Control& no_control() {
    static const Control none;
    return none;
}

void WorkMeter::look() {
    if (control_.cancel.raised()) throw Cancelled();
    next_ = progress_.done + interval_;
    charge(0);
    if (control_.on_progress) control_.on_progress(progress_);
}

void WorkMeter::charge(double seconds) {
    owed_ += seconds;
    if (control_.work) control_.work->add(progress_.stage, std::exchange(owed_, 0));
}

} // namespace graftal
