#include "runtime/image/files/claims.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace graftal {

namespace {

/// Whole numbers from a file, the least byte first.
class Reader {
  public:
    explicit Reader(const std::string& path) : file_(path, std::ios::binary) {}

    bool reads(const std::string& stamp) {
        std::string head(stamp.size(), 0);
        file_.read(head.data(), static_cast<std::streamsize>(head.size()));
        return good() && head == stamp;
    }
    std::uint32_t number(int bytes) {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 8 * bytes; shift += 8)
            value |= (static_cast<std::uint32_t>(file_.get()) & 255u) << shift;
        return value;
    }
    /// Up to the byte 0, which is left out; the file is not good() any more where that is too far away.
    std::string text() {
        std::array<char, 257> text{};
        file_.getline(text.data(), text.size(), '\0');
        return text.data();
    }
    void skip(std::uint32_t bytes) { file_.seekg(bytes, std::ios::cur); }
    std::uint64_t position() { return static_cast<std::uint64_t>(file_.tellg()); }
    bool good() const { return file_.good(); }

  private:
    std::ifstream file_;
};

/// OpenImageIO makes the canvas when it opens the file: 23 bytes may ask for 16 GiB. Its reader looks at no
/// more of the stamp than the first three letters, and so do we.
bool is_huge_gif(const std::string& path) {
    Reader file(path);
    if (!file.reads("GIF")) return false;
    file.skip(3);
    const std::uint64_t width = file.number(2), height = file.number(2);
    return file.good() && 4 * width * height > most_held_samples;
}

/// OpenEXR makes room for an attribute as long as it says it is. Each is a name, a type, a length and so many
/// bytes; an empty name ends a header, and another one all headers of a file of many parts.
bool has_attribute_beyond_end(const std::string& path) {
    std::error_code error;
    const std::uintmax_t file_bytes = std::filesystem::file_size(path, error);
    Reader file(path);
    if (error || !file.reads("\x76\x2f\x31\x01")) return false;
    const bool many_parts = file.number(4) & 0x1000;
    for (bool ended = false; file.good();) {
        if (file.text().empty()) {
            if (!many_parts || ended) return false;
            ended = true;
            continue;
        }
        ended = false;
        file.text();
        const std::uint32_t bytes = file.number(4);
        if (file.good() && bytes > file_bytes - file.position()) return true;
        file.skip(bytes);
    }
    return false;
}

} // namespace

std::string false_claim(const std::string& path) {
    if (is_huge_gif(path)) return "it is too large";
    return has_attribute_beyond_end(path) ? "its head reaches beyond its end" : "";
}

} // namespace graftal
