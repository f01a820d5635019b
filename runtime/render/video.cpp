#include "runtime/render/video.h"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/system/file.h"
#include "runtime/system/process.h"

namespace graftal {

namespace {

constexpr const char* program = "ffmpeg";

/// ffmpeg's arguments. It runs in the directory of the frames, whose name may hold what it would take for a
/// pattern.
std::vector<std::string> arguments(const FrameStore& frames, FrameRate rate, const std::string& output) {
    std::vector<std::string> words = {program, "-hide_banner", "-nostdin", "-loglevel", "error", "-y"};
    const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
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

/// The last line of what a program has said.
std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

} // namespace

Status video_available() {
    if (find_program(program)) return {};
    return Status::failure(fmt::format(
        "cannot find the program '{0}'; install it with 'apt-get install {0}', or make an animated "
        ".png or .gif",
        program));
}

Status write_video(const std::string& path, const FrameStore& frames, FrameRate rate,
                   const CancelFlag& cancel) {
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    std::string messages;
    ProcessOptions options;
    options.cancel = cancel;
    options.arguments = arguments(frames, rate, std::filesystem::absolute(pending.temporary_path()).string());
    options.directory = frames.directory();
    options.on_error_text = [&](std::string_view text) {
        constexpr std::size_t enough = 1 << 16;
        if (messages.size() < enough) messages += text;
    };
    const ProcessResult result = run_process(options);
    if (!result.status.ok()) return result.status;
    if (result.cancelled) return Status::failure("interrupted");
    if (result.signal) return Status::failure(fmt::format("'{}' ended by signal {}", program, result.signal));
    if (result.exit_code != 0)
        return Status::failure(
            fmt::format("'{}' failed with status {}: {}", program, result.exit_code, last_line(messages)));
    return pending.commit();
}

} // namespace graftal
