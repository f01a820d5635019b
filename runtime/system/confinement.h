#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace graftal {

/// Limits on a child. No core is dumped. Files are the kernel's business (Landlock, Linux 5.13 and later):
/// where it has none, or switched off, they are as open to the child as to us.
struct Confinement {
    std::uint64_t memory_bytes = 0; ///< of its own, for data; 0: no limit
    std::uint64_t file_bytes = 0;   ///< of the largest file that it writes; 0: no limit
    std::uint64_t cpu_seconds = 0;  ///< of all its threads; 0: no limit
    /// Files, and folders with all in them; what is not there is passed over. The program and what programs
    /// need to start are readable anyhow.
    std::vector<std::string> readable;
    std::vector<std::string> writable; ///< and readable
};

/// Whether the kernel can keep a child to its files.
bool can_confine_files();

/// A Confinement made ready before fork(), since only system calls are safe after it.
class PreparedConfinement {
  public:
    /// `program`: what will be executed.
    PreparedConfinement(const Confinement& confinement, const std::string& program);
    ~PreparedConfinement();
    PreparedConfinement(const PreparedConfinement&) = delete;
    PreparedConfinement& operator=(const PreparedConfinement&) = delete;

    /// Confines the calling process for ever. False, with errno, where that failed.
    bool apply() const;

  private:
    void allow(const std::string& path, std::uint64_t rights);

    Confinement confinement_;
    int rules_ = -1; ///< of Landlock; -1: none
    std::uint64_t handled_ = 0;
};

} // namespace graftal
