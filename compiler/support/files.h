#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "compiler/support/status.h"

namespace graftal {

/// The state of a file, to see whether it was written since: zeros where there is none.
struct FileStamp {
    std::int64_t time = 0;
    std::uint64_t bytes = 0;
    bool operator==(const FileStamp&) const = default;
};

/// The door to the files that a model names: the compiler opens none by itself. Paths are as the model and
/// its caller write them, put together by path_text.h. Threads may share it.
class Files {
  public:
    virtual ~Files() = default;

    /// Fails where no regular file is: others (pipes, devices) could keep a reader waiting for ever.
    virtual Status check(const std::string& path) const = 0;
    /// Reads a regular file, or standard input for "-". Fails beyond some hundred MiB.
    virtual Status read(const std::string& path, std::string& text) const = 0;
    virtual FileStamp stamp(const std::string& path) const = 0;
    /// Whether a path, there or not, leads into a folder, with all symbolic links resolved on both sides.
    virtual bool lies_in(const std::string& path, const std::string& folder) const = 0;
};

/// Texts in memory. Other paths are looked up in `below`, which outlives it; null: there are no others. So
/// the texts of open editors lie over the files on a disk.
class MemoryFiles final : public Files {
  public:
    explicit MemoryFiles(const Files* below = nullptr) : below_(below) {}

    void set(const std::string& path, std::string text);
    void remove(const std::string& path);

    Status check(const std::string& path) const override;
    Status read(const std::string& path, std::string& text) const override;
    FileStamp stamp(const std::string& path) const override;
    bool lies_in(const std::string& path, const std::string& folder) const override;

  private:
    struct Entry {
        std::string text;
        std::int64_t edit = 0;
    };
    const Entry* find(const std::string& path) const;

    const Files* below_;
    std::map<std::string, Entry> entries_; ///< by normalised path
    std::int64_t edits_ = 0;
};

/// The files of another door, and a listener that hears of each path that is looked for, there or not.
class HeardFiles final : public Files {
  public:
    using Listener = std::function<void(const std::string& path)>;
    HeardFiles(const Files& files, Listener listener) : files_(files), listener_(std::move(listener)) {}

    Status check(const std::string& path) const override {
        listener_(path);
        return files_.check(path);
    }
    Status read(const std::string& path, std::string& text) const override { return files_.read(path, text); }
    FileStamp stamp(const std::string& path) const override { return files_.stamp(path); }
    bool lies_in(const std::string& path, const std::string& folder) const override {
        return files_.lies_in(path, folder);
    }

  private:
    const Files& files_;
    Listener listener_;
};

/// Without a file.
inline const MemoryFiles& no_files() {
    static const MemoryFiles none;
    return none;
}

} // namespace graftal
