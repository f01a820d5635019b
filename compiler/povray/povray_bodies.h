#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/povray/cut.h"
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

/// Writes the bodies of a cut: meshes as declarations, and all as placed objects.
class PovrayBodies {
  public:
    /// `prefix` begins every name.
    PovrayBodies(const Cut& cut, const std::string& prefix);

    /// Of the meshes that are placed.
    std::uint64_t triangle_count() const { return triangle_count_; }
    bool is_plane(std::uint32_t body) const;

    /// `#declare`s each mesh that is placed; false if the sink stopped.
    bool declare(SdlWriter& out, ProgressMarks& progress) const;

    /// The placed body, as one object with `texture` (which may be empty) at its end. Primitives that need
    /// no matrix have none: POV-Ray takes less than half the memory for them.
    void place(SdlWriter& out, std::uint32_t body, const Affine& pov_from_body,
               std::string_view texture) const;

  private:
    struct Use {
        std::string name; ///< of the declaration; empty if nothing is to be declared
        bool palette = false;
    };

    const Cut& cut_;
    std::vector<Use> uses_; ///< by body
    std::uint64_t triangle_count_ = 0;
};

} // namespace graftal
