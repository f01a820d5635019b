#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace graftal {

/// A run of graftal in the background, in the folder of the test. It is killed where it outlives this.
class BackgroundRun {
  public:
    BackgroundRun(const std::string& folder, const std::vector<std::string>& arguments);
    ~BackgroundRun();
    BackgroundRun(const BackgroundRun&) = delete;
    BackgroundRun& operator=(const BackgroundRun&) = delete;

    bool running();
    void send(int signal) const;
    /// The exit status as a shell has it, negative after a signal that ended the process itself.
    int wait();
    std::string messages() const;
    /// It does not die of the signal, but has a handler: it is drawing.
    bool catches(int signal) const;
    /// Waits until something is so, or the run has ended, or a minute is over. Whether it is so.
    bool wait_until(const std::function<bool()>& so);

  private:
    void start(const std::string& folder, const std::vector<std::string>& arguments) const;
    void note(pid_t id) { ended_ = id != 0; }

    std::string messages_;
    pid_t id_ = 0;
    int wait_status_ = 0;
    bool ended_ = false;
};

} // namespace graftal
