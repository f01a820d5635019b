#include "compiler/povray/emit/progress_marks.h"

#include <algorithm>

namespace graftal {

void ProgressMarks::mark() {
    out_ << "\n#debug \"@@" << std::min<std::uint64_t>(done_ * 100 / parts_, 100) << "\\n\"\n";
    next_ = done_ * 100 / parts_ + 1;
}

} // namespace graftal
