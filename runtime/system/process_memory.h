#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace graftal {

/// The number of kilobytes behind a word such as "VmHWM:" in /proc/PROCESS/status, as bytes; 0 if it is not
/// there. `process`: a number, or "self".
std::uint64_t memory_of(const std::string& process, std::string_view word);

} // namespace graftal
