#include "runtime/studio/server/page_session.h"

#include <utility>

namespace graftal {

PageSession::PageSession(std::unique_ptr<StudioHome> home, std::function<void()> on_message,
                         std::function<void()> on_end)
    : home_(std::move(home)), outbox_(std::move(on_message)), session_(*home_, outbox_, [this] { wake(); }),
      on_end_(std::move(on_end)), thread_([this] { work(); }) {}

PageSession::~PageSession() {
    stop();
    thread_.join();
}

void PageSession::hear(std::string_view message) {
    session_.hear(message);
    outbox_.forget_before(session_.newest());
    wake();
}

void PageSession::wake() {
    const std::lock_guard lock(mutex_);
    heard_ = true;
    changed_.notify_all();
}

void PageSession::stop() {
    session_.stop();
    outbox_.close();
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
}

void PageSession::work() {
    constexpr double budget_seconds = 1; // what is heard ends a piece earlier
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return stopped_ || heard_; });
            if (stopped_) break;
            heard_ = false;
        }
        while (session_.work(budget_seconds)) {
        }
    }
    on_end_();
}

} // namespace graftal
