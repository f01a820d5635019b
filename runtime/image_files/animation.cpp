#include "runtime/image_files/animation.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "runtime/image_files/png_chunks.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

/// Writes one animated PNG, chunk by chunk.
class AnimatedPng {
  public:
    AnimatedPng(std::string path, std::size_t frame_count, FrameRate rate)
        : path_(std::move(path)), frame_count_(frame_count) {
        const int common = std::gcd(100, rate.hundredths);
        delay_ = big_endian(static_cast<std::uint32_t>(100 / common), 2) +
                 big_endian(static_cast<std::uint32_t>(rate.hundredths / common), 2);
    }

    Status open(const std::string& temporary) {
        file_.reset(std::fopen(temporary.c_str(), "wb"));
        return file_ ? put(png_signature) : system_failure("write", path_);
    }

    Status add(const std::string& frame) {
        std::string text;
        Status status = read_text(frame, text);
        if (!status.ok()) return status;
        const std::optional<std::vector<PngChunk>> chunks = png_chunks(text);
        if (!chunks) return Status::failure(fmt::format("'{}' is damaged", frame));
        if (header_.empty())
            status = put_head(*chunks);
        else if (header_ != chunks->front().data)
            status =
                Status::failure(fmt::format("'{}' has another size or kind than the first frame", frame));
        // The header begins with width and height; the frame covers all, from the corner on, and stays.
        if (status.ok())
            status = put_chunk("fcTL", big_endian(sequence_++) + header_.substr(0, 8) + big_endian(0) +
                                           big_endian(0) + delay_ + std::string(2, '\0'));
        for (const PngChunk& chunk : *chunks)
            if (status.ok() && chunk.type == "IDAT") status = put_pixels(chunk.data);
        first_ = false;
        return status;
    }

    Status close() {
        const Status status = put_chunk("IEND", {});
        if (!status.ok()) return status;
        return std::fclose(file_.release()) == 0 ? Status() : system_failure("write", path_);
    }

  private:
    Status put(std::string_view text) {
        return std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size()
                   ? Status()
                   : system_failure("write", path_);
    }
    Status put_chunk(std::string_view type, std::string_view data) { return put(png_chunk(type, data)); }

    /// Writes the chunks before all frames. Those of the first frame tell the colours and the making of all.
    Status put_head(const std::vector<PngChunk>& chunks) {
        header_ = chunks.front().data;
        Status status = put_chunk("IHDR", header_);
        if (status.ok())
            status = put_chunk("acTL", big_endian(static_cast<std::uint32_t>(frame_count_)) + big_endian(0));
        constexpr std::string_view copied[] = {"sRGB", "gAMA", "cHRM", "iCCP",
                                               "sBIT", "PLTE", "tRNS", "tEXt"};
        for (const PngChunk& chunk : chunks)
            if (status.ok() &&
                std::find(std::begin(copied), std::end(copied), chunk.type) != std::end(copied))
                status = put_chunk(chunk.type, chunk.data);
        return status;
    }

    /// The first frame is what a viewer of still pictures shows.
    Status put_pixels(std::string_view data) {
        if (first_) return put_chunk("IDAT", data);
        return put_chunk("fdAT", big_endian(sequence_++) + std::string(data));
    }

    std::string path_;
    std::size_t frame_count_;
    std::string delay_;
    OpenFile file_;
    std::string header_;
    std::uint32_t sequence_ = 0;
    bool first_ = true;
};

} // namespace

Status write_animated_png(const std::string& path, const std::vector<std::string>& frames, FrameRate rate,
                          const OnFrame& on_frame) {
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    AnimatedPng animation(path, frames.size(), rate);
    Status status = animation.open(pending.temporary_path());
    for (std::size_t i = 0; i < frames.size() && status.ok(); ++i)
        status = on_frame(i) ? animation.add(frames[i]) : Status::failure("interrupted");
    if (status.ok()) status = animation.close();
    return status.ok() ? pending.commit() : status;
}

} // namespace graftal
