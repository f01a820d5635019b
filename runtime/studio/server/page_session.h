#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>

#include "runtime/studio/server/outbox.h"
#include "runtime/studio/studio_session.h"

namespace graftal {

/// A page's session and the thread that works for it.
class PageSession {
  public:
    /// `on_message`: Outbox. `on_end`: the thread has nothing left to do; called by it, as its last act.
    PageSession(std::unique_ptr<StudioHome> home, std::function<void()> on_message,
                std::function<void()> on_end);
    /// Waits for the thread.
    ~PageSession();
    PageSession(const PageSession&) = delete;
    PageSession& operator=(const PageSession&) = delete;

    void hear(std::string_view message);
    bool take(Outbox::Message& message) { return outbox_.take(message); }
    /// Ends the work soon; does not wait.
    void stop();

  private:
    void work();
    void wake();

    std::unique_ptr<StudioHome> home_;
    Outbox outbox_;
    StudioSession session_;
    std::function<void()> on_end_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool heard_ = true; ///< something since the thread looked
    bool stopped_ = false;
    std::thread thread_; ///< last: it uses all of the above
};

} // namespace graftal
