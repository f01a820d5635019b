#include "runtime/render/video.h"

#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "runtime/system/file.h"
#include "runtime/system/process.h"

namespace graftal {

namespace {

constexpr const char* program = "ffmpeg";

/// ffmpeg's arguments. It runs in the directory of the frames, whose name may hold what it would take for a
/// pattern.
std::vector<std::string> arguments(const FrameStore& frames, FrameRate rate, const std::string& output) {
    std::vector<std::string> words = {program, "-hide_banner", "-nostdin", "-loglevel",
                                      "error", "-nostats",     "-y"};
    const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
    add({"-progress", "pipe:2"});
    add({"-framerate", fmt::format("{}/100", rate.hundredths), "-f", "image2", "-start_number", "1"});
    add({"-i", frames.name_pattern(), "-frames:v", std::to_string(frames.count())});
    // Colours by the rules of high definition, and said so; else players guess by the size.
    add({"-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"});
    add({"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"});
    if (output.ends_with(".webm"))
        add({"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0"});
    else
        add({"-c:v", "libx264", "-crf", "17", "-preset", "medium", "-movflags", "+faststart"});
    add({"file:" + output});
    return words;
}

/// Standard error of ffmpeg, line by line: its progress is lines of "key=value", all others are messages.
class Listener {
  public:
    explicit Listener(std::function<void(std::size_t done)> on_done) : on_done_(std::move(on_done)) {}

    void hear(std::string_view text) {
        for (const char c : text)
            if (c == '\n')
                end_line();
            else if (line_.size() < longest_line)
                line_ += c;
    }

    /// The last message.
    const std::string& last() {
        end_line();
        return last_;
    }

  private:
    static constexpr std::size_t longest_line = 1 << 16;

    void end_line() {
        const std::string line = std::exchange(line_, {});
        const std::size_t key = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789");
        if (key == std::string::npos || key == 0 || line[key] != '=') {
            if (!line.empty()) last_ = line;
            return;
        }
        std::size_t done = 0;
        if (on_done_ && line.starts_with("frame=") &&
            std::from_chars(line.data() + key + 1, line.data() + line.size(), done).ec == std::errc())
            on_done_(done);
    }

    std::function<void(std::size_t done)> on_done_;
    std::string line_, last_;
};

} // namespace

Status video_available() {
    if (find_program(program)) return {};
    return Status::failure(fmt::format(
        "cannot find the program '{0}'; install it with 'apt-get install {0}', or make an animated "
        ".png or .gif",
        program));
}

Status write_video(const std::string& path, const FrameStore& frames, FrameRate rate,
                   const CancelFlag& cancel, const std::function<void(std::size_t done)>& on_done) {
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    Listener listener(on_done);
    ProcessOptions options;
    options.cancel = cancel;
    options.arguments = arguments(frames, rate, std::filesystem::absolute(pending.temporary_path()).string());
    options.directory = frames.directory();
    options.on_error_text = [&](std::string_view text) { listener.hear(text); };
    const ProcessResult result = run_process(options);
    if (!result.status.ok()) return result.status;
    if (result.cancelled) return Status::failure("interrupted");
    if (result.signal) return Status::failure(fmt::format("'{}' ended by signal {}", program, result.signal));
    if (result.exit_code != 0)
        return Status::failure(
            fmt::format("'{}' failed with status {}: {}", program, result.exit_code, listener.last()));
    return pending.commit();
}

} // namespace graftal
