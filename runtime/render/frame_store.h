#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/source.h"
#include "compiler/support/status.h"
#include "runtime/system/made_folders.h"

namespace graftal {

/// The frames of an animation as PNG files in a directory, which outlives the program: what one run has drawn
/// the next one finds. Each carries a stamp that says what it was made from.
class FrameStore {
  public:
    FrameStore(std::string directory, std::size_t count);
    ~FrameStore();
    FrameStore(const FrameStore&) = delete;
    FrameStore& operator=(const FrameStore&) = delete;

    /// Makes the directory if it is missing, and locks it (flock): fails where another run is at work in it.
    /// A directory that was made here and has nothing in it in the end goes with this.
    Status create();
    /// Does the work of create() without the lock: many may draw in it, each its own frames.
    Status join();

    const std::string& directory() const { return directory_; }
    std::size_t count() const { return count_; }
    /// File name of a frame, from 0: frame_0001.png and so on, with as many digits as the last needs.
    std::string name(std::size_t frame) const;
    std::string path(std::size_t frame) const { return directory_ + "/" + name(frame); }
    std::vector<std::string> paths() const;
    /// The names as printf has them, for programs that read numbered pictures.
    std::string name_pattern() const;

    /// True if the file is a whole PNG with this stamp.
    bool has(std::size_t frame, const std::string& stamp) const;

    /// Removes what runs that were killed have left half written.
    void tidy() const;
    /// Removes all frames, those of other animations that bear a stamp of ours too, and the directory if
    /// nothing else is in it. Requires that the animation is done: each of its frames was found or drawn.
    void remove() const;
    /// Removes a frame that is not wanted after all.
    void remove(std::size_t frame) const;
    /// Pictures in the directory that are named like frames but are not of this animation.
    std::size_t strangers() const;

  private:
    bool is_frame_name(const std::string& name) const;

    std::string directory_;
    std::size_t count_;
    int digits_;
    MadeFolders made_; ///< taken back in the end if they are empty
    int lock_ = -1;
};

/// 64 bits of what has been added, as hexadecimal digits: FNV-1a, lengths included.
class Digest {
  public:
    Digest& add(std::string_view text);
    /// The texts of all files that a compilation has read.
    Digest& add(const SourceMap& sources);
    std::string text() const;
    bool operator==(const Digest&) const = default;

  private:
    void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }

    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

} // namespace graftal
