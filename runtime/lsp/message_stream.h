#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace graftal {

/// Cuts a stream of bytes into messages as the Language Server Protocol has them: lines of a header with
/// `Content-Length: N`, an empty line, and N bytes.
class MessageStream {
  public:
    static constexpr std::size_t most_header = 4096;
    static constexpr std::size_t most_content = std::size_t{64} << 20;

    /// Takes the next bytes.
    void add(std::string_view bytes) { bytes_ += bytes; }
    /// The next whole message; nothing where more bytes are needed, or after a fault.
    std::optional<std::string> next();
    /// The stream makes no sense any more, and nobody can tell where the next message begins: why, or "".
    const std::string& fault() const { return fault_; }

  private:
    bool read_header();

    std::string bytes_;
    std::optional<std::size_t> content_; ///< size of the message whose header was read
    std::string fault_;
};

/// A message with its header.
std::string framed(std::string_view content);

} // namespace graftal
