#include "runtime/render/frame_store.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "runtime/image_files/image_files.h"
#include "runtime/image_files/png_chunks.h"
#include "runtime/system/file.h"

namespace graftal {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = "frame_", suffix = ".png";

/// The stamp of a whole PNG, or nothing.
std::optional<std::string> frame_stamp(const std::string& path) {
    std::string text;
    if (!read_text(path, text, 1u << 30).ok()) return std::nullopt;
    const std::optional<std::vector<PngChunk>> chunks = png_chunks(text);
    return chunks ? png_text(*chunks, stamp_keyword) : std::nullopt;
}

std::vector<std::string> names_in(const std::string& directory) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename().string());
    return names;
}

} // namespace

FrameStore::FrameStore(std::string directory, std::size_t count)
    : directory_(std::move(directory)), count_(count),
      digits_(std::max(4, static_cast<int>(std::to_string(count).size()))) {}

Status FrameStore::join() {
    return made_.make(directory_);
}

Status FrameStore::create() {
    if (Status status = join(); !status.ok()) return status;
    std::error_code error;
    lock_ = lock_path(fs::canonical(directory_, error).string());
    // The run that had the lock may have removed it just now.
    if (lock_ >= 0 && fs::exists(directory_, error)) return {};
    return Status::failure(
        fmt::format("another run of graftal is working on the frames in '{}'", directory_));
}

FrameStore::~FrameStore() {
    if (lock_ < 0) return;
    made_.take_back();
    ::close(lock_);
}

std::string FrameStore::name(std::size_t frame) const {
    return fmt::format("{}{:0{}}{}", prefix, frame + 1, digits_, suffix);
}

std::vector<std::string> FrameStore::paths() const {
    std::vector<std::string> paths;
    for (std::size_t frame = 0; frame < count_; ++frame)
        paths.push_back(path(frame));
    return paths;
}

std::string FrameStore::name_pattern() const {
    return fmt::format("{}%0{}d{}", prefix, digits_, suffix);
}

bool FrameStore::has(std::size_t frame, const std::string& stamp) const {
    return frame_stamp(path(frame)) == stamp;
}

bool FrameStore::is_frame_name(const std::string& name) const {
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
    const std::string number = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    return number.size() >= 4 &&
           std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

void FrameStore::tidy() const {
    // PendingFile names half-written frames so.
    for (const std::string& name : names_in(directory_))
        if (name.starts_with("." + std::string(prefix)) && name.ends_with(suffix)) {
            std::error_code ignored;
            fs::remove(directory_ + "/" + name, ignored);
        }
}

void FrameStore::remove() const {
    // Names of the animation's own frames are known without a look at the directory, which may fail.
    for (const std::string& path : paths())
        ::unlink(path.c_str());
    std::error_code ignored;
    for (const std::string& name : names_in(directory_))
        if (is_frame_name(name) && frame_stamp(directory_ + "/" + name))
            fs::remove(directory_ + "/" + name, ignored);
    fs::remove(directory_, ignored); // fails if something else is in it
}

void FrameStore::remove(std::size_t frame) const {
    ::unlink(path(frame).c_str());
}

std::size_t FrameStore::strangers() const {
    const std::vector<std::string> names = names_in(directory_);
    const auto frames = std::count_if(names.begin(), names.end(),
                                      [this](const std::string& name) { return is_frame_name(name); });
    return static_cast<std::size_t>(frames) - std::min(count_, static_cast<std::size_t>(frames));
}

Digest& Digest::add(std::string_view text) {
    for (std::size_t length = text.size(), i = 0; i < sizeof length; ++i)
        add_byte(static_cast<unsigned char>(length >> (8 * i)));
    for (const char c : text)
        add_byte(static_cast<unsigned char>(c));
    return *this;
}

Digest& Digest::add(const SourceMap& sources) {
    for (FileId file = 0; file < sources.size(); ++file)
        add(sources.text(file));
    return *this;
}

std::string Digest::text() const {
    return fmt::format("{:016x}", hash_);
}

} // namespace graftal
