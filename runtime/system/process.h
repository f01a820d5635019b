#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/status.h"
#include "runtime/system/confinement.h"

namespace graftal {

struct ProcessOptions {
    std::vector<std::string> arguments; ///< [0] is the program: a path, or a name that find_program knows
    std::string directory;              ///< where it runs; empty: here
    std::vector<std::pair<std::string, std::string>> environment; ///< set on top of ours
    /// The child sees only those of our variables that programs need to be found: PATH and LD_LIBRARY_PATH.
    bool clean_environment = false;
    std::optional<Confinement> confinement; ///< nothing: as free as we are
    /// Receives standard error as it comes. Standard input and output of the child are /dev/null.
    std::function<void(std::string_view)> on_error_text;
    bool output_with_errors = false; ///< standard output is received with standard error
    CancelFlag cancel;               ///< ends the child
    /// From when that is raised to SIGKILL.
    double grace_seconds = 10;
};

/// The end of a child, and what it used.
struct ProcessResult {
    Status status;          ///< fails only where the child could not be started or watched
    int exit_code = 0;      ///< -1 if a signal ended it
    int signal = 0;         ///< the signal that ended it, or 0
    bool cancelled = false; ///< and ended by us for that
    double wall_seconds = 0;
    std::uint64_t peak_bytes = 0; ///< resident memory at its highest

    bool succeeded() const { return status.ok() && exit_code == 0 && signal == 0 && !cancelled; }
};

/// Where `name` lies on PATH; as it is if it holds a slash. Nothing if there is no such executable file.
std::optional<std::string> find_program(const std::string& name);

/// Runs a program to its end, without a shell. Who cancels it ends the child by SIGTERM, and by SIGKILL after
/// the grace. The child dies with us, whatever ends us. Requires a program that find_program has found.
ProcessResult run_process(const ProcessOptions& options);

} // namespace graftal
