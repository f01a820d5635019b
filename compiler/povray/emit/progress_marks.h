#pragma once

#include <cstdint>

#include "compiler/povray/sdl_writer.h"

namespace graftal {

/// Marks the way through a scene: `#debug "@@p\n"` after each percent of its parts, which POV-Ray prints as
/// it reads them. A part is a placement or a triangle; they take about as long to parse.
class ProgressMarks {
  public:
    ProgressMarks(SdlWriter& out, std::uint64_t parts, bool enabled)
        : out_(out), parts_(enabled ? parts : 0) {}

    /// After one more part. Only between tokens.
    void step() {
        if (++done_ * 100 >= next_ * parts_ && parts_ > 0) mark();
    }

  private:
    void mark();

    SdlWriter& out_;
    std::uint64_t parts_;
    std::uint64_t done_ = 0;
    std::uint64_t next_ = 1; ///< percent
};

} // namespace graftal
