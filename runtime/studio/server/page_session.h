#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_session.h"

namespace graftal {

/// Messages on their way to a page. The session's thread puts them in, and waits where the page takes them
/// too slowly; the server's thread takes them out.
class Outbox final : public StudioSink {
  public:
    struct Message {
        std::string bytes;
        bool binary = false;
    };

    /// `on_message`: called after each message that is put in, by the thread that does so.
    explicit Outbox(std::function<void()> on_message) : on_message_(std::move(on_message)) {}

    void text(const std::string& message) override { put({message, false}); }
    void binary(const std::string& message) override { put({message, true}); }

    /// The oldest message; nothing where there is none.
    bool take(Message& message);
    /// Tiles of states before this one are of no use any more.
    void forget_before(std::uint32_t number);
    /// Nobody takes messages any more: those to come vanish.
    void close();

    /// Bytes that may wait.
    static constexpr std::size_t most_bytes = 16u << 20u;

  private:
    void put(Message message);

    std::function<void()> on_message_;
    std::mutex mutex_;
    std::condition_variable has_room_;
    std::deque<Message> messages_;
    std::size_t bytes_ = 0;
    std::uint32_t oldest_ = 0; ///< number of a state
    bool closed_ = false;
};

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
    std::function<void()> on_end_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool heard_ = true; ///< something since the thread looked
    bool stopped_ = false;
    StudioSession session_; ///< behind what its jobs wake
    std::thread thread_;    ///< last: it uses all of the above
};

} // namespace graftal
