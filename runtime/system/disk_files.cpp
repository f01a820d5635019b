#include "runtime/system/disk_files.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "runtime/system/file.h"

namespace graftal {

namespace {

class DiskFiles final : public Files {
  public:
    Status check(const std::string& path) const override {
        std::error_code code;
        if (!std::filesystem::exists(path, code)) return system_failure("open", path, ENOENT);
        if (is_special_file(path))
            return Status::failure(fmt::format("'{}' is {}", path, special_file_text(path)));
        return {};
    }
    Status read(const std::string& path, std::string& text) const override { return read_text(path, text); }
    FileStamp stamp(const std::string& path) const override { return stamp_of(path); }
    bool lies_in(const std::string& path, const std::string& folder) const override {
        return graftal::lies_in(path, folder);
    }
};

} // namespace

const Files& disk_files() {
    static const DiskFiles files;
    return files;
}

} // namespace graftal
