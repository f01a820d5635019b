#pragma once

#include <cstdint>
#include <string>

#include "compiler/support/diagnostics.h"

namespace graftal {

/// The error of a picture that had to be drawn coarser than it was asked for, in pixels.
struct CoarserError {
    double px = 0;
    double asked_px = 0;
};

/// The limit that did not allow a finer picture.
struct Limit {
    std::string allowed;   ///< such as "2 GiB of memory"
    std::string option;    ///< the option that gives more
    std::string besides{}; ///< another change to the picture, or ""
    std::string need{};    ///< a sentence on what the picture as asked would take, or ""
    std::string or_else{}; ///< another way to a finer picture, or ""
};

/// Three digits and a unit.
std::string readable_bytes(double bytes);

/// Two digits, rounded up, without a power of ten where people write none: "110", "3200".
std::string readable_seconds(double seconds);

/// The limit of DetailOptions::memory_bytes.
Limit limit_of_memory(std::uint64_t bytes);
/// The limit of DetailOptions::work_seconds.
Limit limit_of_work(double seconds);

/// Warns that a limit made the picture coarser. `root`: the place of the model's root.
void warn_of_limit(const Span& root, const Limit& limit, const CoarserError& error, Diagnostics& diagnostics);

/// Warns that shells (shell/shell.h) have not as many points as they should.
void warn_of_shells(const Span& root, const CoarserError& error, Diagnostics& diagnostics);

} // namespace graftal
