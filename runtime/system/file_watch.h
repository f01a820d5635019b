#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "compiler/support/status.h"

namespace graftal {

/// Tells when files change: are written to their ends, replaced, made, moved or removed. It watches the
/// folders that they lie in by inotify, so a file need not be there yet. Links are followed, and may change
/// too. What other machines do on a network's file system is not seen. A thread waits for the kernel.
class FileWatch {
  public:
    FileWatch();
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// Fails for a file that cannot be watched, and says why: the kernel has limits.
    Status status() const;

    /// From now on changes of this file count.
    void add(const std::string& path);

    /// Whether there is anything to take(), or status() has failed since. Many threads may ask often.
    bool changed() const { return changed_; }
    /// Readable while changed() is true.
    int descriptor() const { return news_; }
    /// The files that have changed since the last call, by the paths that add() was given.
    std::vector<std::string> take();

  private:
    /// A folder that the kernel watches. A change of the folder itself is one of the name "".
    struct Folder {
        std::filesystem::path path;
        std::map<std::string, std::set<std::string>> files; ///< by name: those that depend on it
    };

    void fail(const std::string& folder, int error);
    bool watch(const std::filesystem::path& folder, const std::string& name, const std::string& file);
    void follow(const std::filesystem::path& path, const std::string& file, int most_links);
    void run();
    void tell();
    void read_events();
    void note(int folder, std::uint32_t what, const std::string& name);

    int events_ = -1; ///< of inotify
    int news_ = -1, end_ = -1;
    std::atomic<bool> changed_ = false;
    mutable std::mutex mutex_; ///< of all below
    Status status_;
    std::set<std::string> files_;
    std::map<int, Folder> folders_; ///< by inotify's numbers
    std::set<std::string> changed_files_;
    std::thread thread_;
};

} // namespace graftal
