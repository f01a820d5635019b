#include "runtime/system/process_memory.h"

#include <cstdlib>
#include <fstream>

namespace graftal {

std::uint64_t memory_of(const std::string& process, std::string_view word) {
    std::ifstream file("/proc/" + process + "/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(word)) return 1024 * std::strtoull(line.c_str() + word.size(), nullptr, 10);
    return 0;
}

} // namespace graftal
