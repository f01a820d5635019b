#include "runtime/image/files/claims.h"

#include <array>
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

/// OpenEXR's reader in C++ makes room for an attribute as long as it says it is; the one in C looks at the
/// length of the file and at the lengths that are known, and reads nothing that is inconsistent.
std::string complaint_about_exr(const std::string& path) {
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {}; // we say it
    exr_context_t file = nullptr;
    const exr_result_t result = exr_start_read(&file, path.c_str(), &settings);
    if (result == EXR_ERR_SUCCESS) exr_finish(&file);
    return result == EXR_ERR_SUCCESS ? "" : exr_get_default_error_message(result);
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
    const std::string complaint = is_exr(path) ? complaint_about_exr(path) : "";
    return complaint.empty() ? "" : "its head is damaged: " + complaint;
}

} // namespace graftal
