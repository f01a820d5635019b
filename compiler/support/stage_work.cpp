#include "compiler/support/stage_work.h"

namespace graftal {

void StageWork::add(std::string_view stage, double seconds) {
    seconds_ += seconds;
    if (seconds_ > limit_) throw OutOfWork(stage, limit_);
}

OutOfWork::OutOfWork(std::string_view stage, double limit_seconds)
    : stage_(stage), limit_seconds_(limit_seconds) {}

} // namespace graftal
