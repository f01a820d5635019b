#include "runtime/export/output_file.h"

#include <cerrno>

#include "compiler/detail/coarser.h"

namespace graftal {

OutputFile::OutputFile(const std::string& path, std::uint64_t most_bytes, bool& too_large)
    : pending_(path), most_bytes_(most_bytes), too_large_(too_large), status_(pending_.status()) {
    if (!status_.ok()) return;
    file_.reset(std::fopen(pending_.temporary_path().c_str(), "wb"));
    if (!file_) fail(errno);
}

void OutputFile::fail(int reason) {
    if (status_.ok()) status_ = system_failure("write", pending_.path(), reason);
}

void OutputFile::flush() {
    if (status_.ok() && written_ + buffer_.size() > most_bytes_) {
        too_large_ = true;
        status_ = Status::failure(fmt::format("'{}' would be larger than {}", pending_.path(),
                                              readable_bytes(static_cast<double>(most_bytes_))));
    }
    if (status_.ok() && std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size())
        fail(errno ? errno : EIO);
    written_ += buffer_.size();
    buffer_.clear();
}

Status OutputFile::close() {
    flush();
    if (file_ && std::fclose(file_.release()) != 0) fail(errno);
    return status_;
}

std::string float_text(double value) {
    return fmt::format("{}", static_cast<float>(value) + 0.0f);
}

} // namespace graftal
