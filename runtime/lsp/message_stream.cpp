#include "runtime/lsp/message_stream.h"

#include <charconv>

#include <fmt/format.h>

#include "compiler/support/small_letters.h"

namespace graftal {

std::string framed(std::string_view content) {
    return fmt::format("Content-Length: {}\r\n\r\n{}", content.size(), content);
}

/// False where it is not whole, or at fault.
bool MessageStream::read_header() {
    constexpr std::string_view field = "content-length:";
    const std::size_t end = bytes_.find("\r\n\r\n");
    if (end == std::string::npos || end > most_header) {
        if (bytes_.size() > most_header) fault_ = "a message begins with no header of a few lines";
        return false;
    }
    for (std::size_t at = 0; at < end;) {
        const std::size_t line_end = std::min(bytes_.find("\r\n", at), end);
        const std::string line = in_small_letters(std::string_view(bytes_).substr(at, line_end - at));
        at = line_end + 2;
        if (!line.starts_with(field)) continue;
        const std::size_t digit = std::min(line.find_first_not_of(' ', field.size()), line.size());
        std::size_t size = 0;
        const auto [rest, error] = std::from_chars(line.data() + digit, line.data() + line.size(), size);
        if (error != std::errc() || rest != line.data() + line.size() || size > most_content) {
            fault_ = fmt::format("a message has a wrong length, or more than {} MiB", most_content >> 20);
            return false;
        }
        content_ = size;
    }
    bytes_.erase(0, end + 4);
    if (!content_) fault_ = "a message has no length";
    return content_.has_value();
}

std::optional<std::string> MessageStream::next() {
    if (!fault_.empty() || (!content_ && !read_header())) return std::nullopt;
    if (bytes_.size() < *content_) return std::nullopt;
    std::string content = bytes_.substr(0, *content_);
    bytes_.erase(0, *content_);
    content_.reset();
    return content;
}

} // namespace graftal
