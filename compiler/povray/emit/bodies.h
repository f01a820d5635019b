#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/emit/progress_marks.h"
#include "compiler/povray/sdl_writer.h"

namespace graftal {

/// Writes the bodies of a cut: meshes as declarations, and all as placed objects.
class PovrayBodies {
  public:
    /// `prefix` begins every name.
    PovrayBodies(const Cut& cut, const std::string& prefix);

    /// Number of triangles of the placed meshes.
    std::uint64_t triangle_count() const { return triangle_count_; }
    bool is_plane(std::uint32_t body) const;
    /// Whether the body is a primitive, and under that map a sheet (sheet.h).
    bool is_sheet(std::uint32_t body, const Mat3& linear) const;

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
        bool solid = false; ///< a mesh that is a part of an operand
    };

    const Cut& cut_;
    std::vector<Use> uses_; ///< by body
    std::uint64_t triangle_count_ = 0;
};

} // namespace graftal
