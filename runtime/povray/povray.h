#pragma once

#include <functional>
#include <optional>
#include <string>

#include "compiler/support/status.h"
#include "runtime/povray/messages.h"
#include "runtime/system/process.h"

namespace graftal {

/// A scene file to be rendered by POV-Ray 3.7 as a child process.
struct PovrayJob {
    std::string program = "povray"; ///< a name for find_program()
    std::string directory;          ///< holds the scene and what it refers to; the picture is written there
    std::string scene = "scene.pov";
    std::string picture = "picture.png";
    int width = 0;
    int height = 0;
    int threads = 0;                ///< 0: as many as POV-Ray likes
    std::optional<int> antialias;   ///< N: adaptive, up to 2^N x 2^N samples a pixel, N in 1..9; nothing: off
    double antialias_threshold = 0; ///< squares are divided whose corners differ by more, in shares of white
    enum class Format {
        srgb8,    ///< 8-bit PNG
        linear16, ///< 16-bit PNG of linear values, at most 1
        half      ///< EXR of half floats, linear and not clipped
    };
    Format format = Format::srgb8;
    std::uint64_t memory_bytes = 0; ///< most memory of the child; 0: no limit
    std::uint64_t cpu_seconds = 0;  ///< of all its threads; 0: no limit
    /// May read and write what we may, with our environment and without limits: for programs that start
    /// POV-Ray somewhere else.
    bool unconfined = false;
    std::optional<std::uint64_t> finite_objects; ///< count for POV-Ray to find; nothing: not checked
    std::uint64_t may_be_empty =
        0; ///< objects among them of which nothing may be left: POV-Ray does not count these
    std::function<void(const PovrayProgress&)> on_progress;
    CancelFlag cancel; ///< ends POV-Ray
};

struct PovrayResult {
    Status status; ///< says what went wrong, with POV-Ray's words and the part of the model at fault
    PovrayLog log;
    ProcessResult process;
};

/// POV-Ray's arguments for the job, without the program.
std::vector<std::string> povray_arguments(const PovrayJob& job);

/// Fails, with advice, if POV-Ray is not installed.
Status povray_available(const std::string& program = "povray");

/// Runs POV-Ray. Success means: exit status 0, the picture is there, "POV-Ray finished" was printed, and no
/// warning that makes the picture wrong. A picture that is no success is removed. No settings of the user's
/// POV-Ray are read. It reads and writes in the job's directory, and reads its own include files, where the
/// kernel can keep it to them (confinement.h). Requires that scene and picture are plain file names.
PovrayResult run_povray(const PovrayJob& job);

/// The body that a line of an emitted scene declares or places, such as `M_leaf` for the model's object
/// `leaf` (PovrayBodies); "" if there is none.
std::string body_at(const std::string& path, int line);

} // namespace graftal
