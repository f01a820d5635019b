#include "runtime/farm/model_copy.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "compiler/import/importers.h"
#include "compiler/support/printable.h"

namespace graftal {

namespace {

namespace fs = std::filesystem;

/// An absolute path that keeps symbolic links, so that the copies lie to each other as models name them.
fs::path whole_path(const std::string& path) {
    return fs::absolute(path).lexically_normal();
}

/// The longest path that all lie below.
fs::path common_folder(const std::set<fs::path>& paths) {
    fs::path common = paths.begin()->parent_path();
    for (const fs::path& path : paths) {
        const auto [end, ignored] = std::mismatch(common.begin(), common.end(), path.begin(), path.end());
        fs::path shared;
        for (auto part = common.begin(); part != end; ++part)
            shared /= *part;
        common = shared;
    }
    return common;
}

Status copy_whole(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::create_directories(to.parent_path(), error);
    if (!error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (!error) return {};
    return Status::failure(
        fmt::format("cannot copy '{}' to '{}': {}", from.string(), to.string(), error.message()));
}

} // namespace

Status copy_model(const std::string& model, const std::vector<std::string>& used, const std::string& folder,
                  ModelCopy& copy) {
    const ModelPath named = model_path(model);
    std::set<fs::path> paths = {whole_path(named.file)};
    for (const std::string& path : used)
        paths.insert(whole_path(path));
    const fs::path common = common_folder(paths);
    copy.model = whole_path(named.file).lexically_relative(common).string();
    if (!named.model.empty()) copy.model += ":" + named.model;
    for (const fs::path& path : paths) {
        const std::string name = path.lexically_relative(common).string();
        if (!is_printable(name))
            return Status::failure(
                fmt::format("'{}': the names in a job are in UTF-8, without line ends and other "
                            "control characters: rename the file",
                            name));
        const fs::path target = fs::path(folder) / name;
        if (Status status = copy_whole(path, target); !status.ok()) return status;
        copy.files.push_back({name, file_digest(target.string())});
    }
    return {};
}

Status check_files(const std::string& folder, const std::vector<JobFile>& files) {
    for (const JobFile& file : files) {
        constexpr std::uint64_t most_bytes = 1u << 30;
        if (file.digest.empty() || digest_below(folder, file.name, most_bytes) != file.digest)
            return Status::failure(
                fmt::format("'{}/{}' is not the file that the job was planned with; plan the job again",
                            folder, file.name));
    }
    return {};
}

} // namespace graftal
