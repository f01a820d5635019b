#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/support/status.h"
#include "runtime/system/file.h"

namespace graftal {

/// A file that appears whole or not at all, written from its begin to its end, or overwritten in its head.
class OutputFile {
  public:
    /// `most_bytes`: a larger file is a failure, and sets `too_large`.
    OutputFile(const std::string& path, std::uint64_t most_bytes, bool& too_large);

    const Status& status() const { return status_; }
    bool ok() const { return status_.ok(); }

    void text(std::string_view text) {
        buffer_.append(text);
        if (buffer_.size() >= room) flush();
    }
    template<typename... Values> void print(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        if (buffer_.size() >= room) flush();
    }
    /// Little-endian.
    void number(float value) { number(std::bit_cast<std::uint32_t>(value)); }
    void number(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            buffer_.push_back(static_cast<char>(value >> shift & 0xff));
    }
    void byte(std::uint8_t value) { buffer_.push_back(static_cast<char>(value)); }

    std::uint64_t size() const { return written_ + buffer_.size(); }

    /// Writes what waits. To be called before the file is committed.
    Status close();
    /// Requires close().
    PendingFile& pending() { return pending_; }

  private:
    static constexpr std::size_t room = 1 << 16;

    void flush();
    void fail(int reason);

    PendingFile pending_;
    OpenFile file_;
    std::string buffer_;
    std::uint64_t written_ = 0;
    std::uint64_t most_bytes_;
    bool& too_large_;
    Status status_;
};

/// "1.5", the shortest text of a 32-bit float; -0 is 0.
std::string float_text(double value);

} // namespace graftal
