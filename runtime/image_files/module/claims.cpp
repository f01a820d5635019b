#include "runtime/image_files/module/claims.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include <openexr.h>

namespace graftal {

namespace {

/// OpenImageIO makes the canvas when it opens the file: 23 bytes may ask for 16 GiB. Its reader looks at no
/// more of the stamp than the first three letters, and so do we.
bool is_huge_gif(const std::string& path) {
    std::array<unsigned char, 10> head{};
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(head.data()), head.size());
    if (!file || head[0] != 'G' || head[1] != 'I' || head[2] != 'F') return false;
    const std::uint64_t width = head[6] + 256u * head[7], height = head[8] + 256u * head[9];
    return 4 * width * height > most_held_samples;
}

/// OpenEXR makes room for a whole tile, which may be much larger than the picture.
bool has_huge_tiles(exr_const_context_t file) {
    int parts = 0;
    exr_get_count(file, &parts);
    for (int part = 0; part < parts; ++part) {
        std::uint32_t width = 0, height = 0;
        const exr_attr_chlist_t* channels = nullptr;
        if (exr_get_tile_descriptor(file, part, &width, &height, nullptr, nullptr) != EXR_ERR_SUCCESS ||
            exr_get_channels(file, part, &channels) != EXR_ERR_SUCCESS)
            continue;
        const double samples = 1.0 * width * height * std::max(1, channels->num_channels);
        if (samples > static_cast<double>(most_held_samples)) return true;
    }
    return false;
}

/// OpenEXR's reader in C++ makes room for an attribute as long as it says it is. The one in C looks at
/// lengths that are known, but not at those of attributes whose type has no name.
std::string complaint_about_exr(const std::string& path) {
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {}; // we say it
    exr_context_t file = nullptr;
    const exr_result_t result = exr_start_read(&file, path.c_str(), &settings);
    if (result != EXR_ERR_SUCCESS) return exr_get_default_error_message(result);
    const bool huge = has_huge_tiles(file);
    exr_finish(&file);
    return huge ? "its tiles are too large" : "";
}

/// Whether an attribute of a head reaches beyond the end of the file. Heads end with an empty name; a file of
/// several has one more empty name after the last.
bool reaches_beyond_its_end(const std::string& path) {
    constexpr std::uint32_t several_heads = 0x1000;
    std::ifstream file(path, std::ios::binary);
    file.seekg(0, std::ios::end);
    const std::streamoff end = file.tellg();
    file.seekg(4);
    const auto number = [&] {
        std::array<unsigned char, 4> bytes{};
        file.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
        return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | std::uint32_t{bytes[3]} << 24;
    };
    const bool several = (number() & several_heads) != 0;
    for (bool first_of_head = true; file;) {
        std::string name, type;
        std::getline(file, name, '\0');
        if (name.empty() && (first_of_head || !several)) return !file;
        first_of_head = name.empty();
        if (name.empty()) continue;
        std::getline(file, type, '\0');
        const std::uint32_t length = number();
        if (!file || length > end - file.tellg()) return true;
        file.seekg(length, std::ios::cur);
    }
    return true;
}

bool is_exr(const std::string& path) {
    std::array<char, 4> stamp{};
    std::ifstream file(path, std::ios::binary);
    file.read(stamp.data(), stamp.size());
    return file && stamp == std::array{'\x76', '\x2f', '\x31', '\x01'};
}

} // namespace

std::string false_claim(const std::string& path) {
    if (is_huge_gif(path)) return "it is too large";
    if (!is_exr(path)) return "";
    if (reaches_beyond_its_end(path)) return "its head is damaged: it reaches beyond the end of the file";
    const std::string complaint = complaint_about_exr(path);
    return complaint.empty() ? "" : "its head is damaged: " + complaint;
}

} // namespace graftal
