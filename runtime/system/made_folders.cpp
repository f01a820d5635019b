#include "runtime/system/made_folders.h"

#include <cerrno>
#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

#include "runtime/system/file.h"

namespace graftal {

Status MadeFolders::make(const std::string& path) {
    std::filesystem::path at;
    int reason = 0;
    for (const std::filesystem::path& part : std::filesystem::path(path)) {
        at /= part;
        if (part.empty()) break; // behind the last slash
        const bool made = ::mkdir(at.c_str(), 0777) == 0;
        reason = made ? 0 : errno;
        if (made) made_.push_back(at.string());
        std::error_code unknown;
        if (!made && !std::filesystem::is_directory(at, unknown)) break;
    }
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return {};
    if (reason == EEXIST) reason = ENOTDIR;
    take_back();
    return system_failure("make the folder", path, reason);
}

void MadeFolders::take_back() {
    for (; !made_.empty(); made_.pop_back())
        ::rmdir(made_.back().c_str());
}

} // namespace graftal
