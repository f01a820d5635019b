#include "runtime/povray/temporary_directory.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

namespace graftal {

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

Status TemporaryDirectory::create() {
    const char* parent = std::getenv("TMPDIR");
    std::string path = std::string(parent && *parent ? parent : "/tmp") + "/graftal-XXXXXX";
    if (!::mkdtemp(path.data()))
        return Status::failure(
            fmt::format("cannot make a temporary directory '{}': {}", path, std::strerror(errno)));
    path_ = path;
    return {};
}

} // namespace graftal
