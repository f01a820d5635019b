#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/support/status.h"
#include "runtime/farm/sweep_axes.h"
#include "runtime/render/render.h"

namespace graftal {

/// A picture in tiles, the frames of an animation, or a picture for each point of a grid of values.
enum class JobKind { tiles, frames, sweep };

std::string_view name_of(JobKind kind);

/// A file that a model is made of.
struct JobFile {
    std::string name;   ///< within JobFolder::model_folder()
    std::string digest; ///< file_digest()
    bool operator==(const JobFile&) const = default;
};

/// The most that a job may have.
inline constexpr std::uint64_t most_tasks = 100'000;

/// Work for a farm, as a value: nothing in it depends on the machine that does it, or the time. Tasks have
/// numbers from 1 on.
struct Job {
    std::string program; ///< program_identity() of who planned it
    JobKind kind = JobKind::tiles;
    /// The command line, without "graftal", of the one run that would do the same; the model lies in
    /// JobFolder::model_folder().
    std::vector<std::string> words;
    std::string result; ///< path of the merge's result, which may be relative to the job's folder
    std::vector<JobFile> files;
    std::uint64_t tasks = 0;
    ImageSize tile{};              ///< of tiles
    std::optional<PictureFit> fit; ///< of tiles: of the whole picture
    std::string framing;           ///< of frames: SharedFraming::json()
    std::string sources;           ///< of frames: MeasuredAnimation::sources
    std::vector<SweepAxis> axes;   ///< of a sweep
    /// JobFolder::identity() of the folder that it was planned in. Only there it may write its result
    /// elsewhere, and run POV-Ray unconfined: a copy of the folder may come from a stranger.
    std::string home;
    double task_seconds = 0;      ///< of one processor that a task takes, about
    std::uint64_t task_bytes = 0; ///< of memory, about

    /// The place of a task's tile in the picture: row by row, cut off at the right and below.
    Tile tile_of(std::uint64_t task) const;
    /// Most bytes of a part.
    std::uint64_t most_part_bytes() const;
    std::uint64_t tile_columns() const;
};

/// Where the parts of a job lie in its folder, which may come from a stranger (files_below.h).
class JobFolder {
  public:
    explicit JobFolder(std::string path) : path_(std::move(path)) {}

    const std::string& path() const { return path_; }
    std::string manifest() const { return path_ + "/job.json"; }
    std::string commands() const { return path_ + "/commands.txt"; } ///< one a line
    std::string model_folder() const { return path_ + "/model"; }
    std::string parts() const { return path_ + "/parts"; }
    std::string tasks() const { return path_ + "/tasks"; }
    std::string result(const Job& job) const;
    std::string part(const Job& job, std::uint64_t task) const; ///< the picture that the task makes
    std::string record(std::uint64_t task) const;               ///< how it ended
    std::string starts(std::uint64_t task) const;               ///< a line for each time that it began
    std::string log(std::uint64_t task) const;                  ///< its last messages

    /// Tells the folder from every other and from its copies, by numbers that nobody can choose; "" for a
    /// folder of another user.
    std::string identity() const;

    /// Requires texts in UTF-8.
    Status write(const Job& job) const;
    /// Fails for a folder that holds no job, or one of another version of graftal's format; and for a job
    /// that asks for more than it may where it is.
    Status read(Job& job) const;

    /// The name of a path of the above within the folder.
    std::string_view name_of(std::string_view path) const { return path.substr(path_.size() + 1); }
    Status read_file(const std::string& path, std::string& text, std::uint64_t most_bytes) const;
    Status write_file(const std::string& path, std::string_view text) const;
    /// Whether others may open it, and right now: a regular file of the folder, there or not.
    Status check_file(const std::string& path) const;
    /// file_digest() of a file in the folder of `most_bytes` at most; "" for others.
    std::string digest(const std::string& path, std::uint64_t most_bytes) const;
    bool has_result(const Job& job) const;
    /// check_file() of a result in the folder. One outside of it has the user chosen.
    Status check_result(const Job& job) const;
    /// Whether this is the very folder that the job was planned in.
    bool is_at_home(const Job& job) const { return !job.home.empty() && job.home == identity(); }

  private:
    std::string numbered(std::uint64_t task, std::string_view ending) const;

    std::string path_;
};

/// The version, and a digest of the very program that runs: two builds may differ in the last bits.
std::string program_identity(const std::string& version);

/// FNV-1a of the file's bytes, 64 bits in hexadecimal digits; "" where it cannot be read. It tells what was
/// changed or cut short, not what was forged.
std::string file_digest(const std::string& path);

/// file_digest() of a regular file below a folder (files_below.h), of `most_bytes` at most; "" for others.
std::string digest_below(const std::string& folder, std::string_view name, std::uint64_t most_bytes);

} // namespace graftal
