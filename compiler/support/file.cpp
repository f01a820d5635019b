#include "compiler/support/file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace graftal {

namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, Close>;

Status system_failure(std::string_view verb, const std::string& path) {
    return Status::failure(fmt::format("cannot {} '{}': {}", verb, path, std::strerror(errno)));
}

Status read_stream(std::FILE* stream, const std::string& path, std::string& text, std::size_t max_bytes) {
    text.clear();
    char buffer[1 << 16];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, stream)) {
        if (text.size() + count > max_bytes)
            return Status::failure(fmt::format("'{}' is longer than {} bytes", path, max_bytes));
        text.append(buffer, count);
    }
    return std::ferror(stream) ? system_failure("read", path) : Status();
}

} // namespace

bool is_special_file(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

Status read_text(const std::string& path, std::string& text, std::size_t max_bytes) {
    if (path == "-") return read_stream(stdin, "standard input", text, max_bytes);
    if (is_special_file(path))
        return Status::failure(fmt::format("cannot read '{}': not a regular file", path));
    const OpenFile file(std::fopen(path.c_str(), "rb"));
    if (!file) return system_failure("open", path);
    return read_stream(file.get(), path, text, max_bytes);
}

PendingFile::PendingFile(std::string path) : path_(std::move(path)) {
    const std::filesystem::path final_path(path_);
    static std::atomic<unsigned> count = 0; // two writers of one file do not share a temporary
    const std::string name = fmt::format(".{}.{}.{}{}", final_path.stem().string(), ::getpid(), ++count,
                                         final_path.extension().string());
    temporary_ = (final_path.parent_path() / name).string();
}

PendingFile::~PendingFile() {
    if (!committed_) ::unlink(temporary_.c_str());
}

Status PendingFile::commit() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) return system_failure("write", path_);
    committed_ = true;
    return {};
}

Status write_text(const std::string& path, std::string_view text) {
    if (path == "-") {
        const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
        if (written && std::fflush(stdout) == 0) return {};
        if (errno == EPIPE) return {}; // as in `graftal print M | head`: the reader has what it wants
        return system_failure("write", "standard output");
    }
    PendingFile pending(path);
    OpenFile file(std::fopen(pending.temporary_path().c_str(), "wb"));
    if (!file) return system_failure("write", path);
    const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
    if (!written || std::fclose(file.release()) != 0) return system_failure("write", path);
    return pending.commit();
}

} // namespace graftal
