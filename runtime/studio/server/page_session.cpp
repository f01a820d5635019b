#include "runtime/studio/server/page_session.h"

#include <chrono>
#include <optional>
#include <utility>

#include "runtime/studio/binary_message.h"

namespace graftal {

namespace {

bool is_outdated(const Outbox::Message& message, std::uint32_t oldest) {
    const std::optional<std::uint32_t> number = message.binary ? state_of_tile(message.bytes) : std::nullopt;
    return number && *number < oldest;
}

} // namespace

void Outbox::put(Message message) {
    {
        std::unique_lock lock(mutex_);
        has_room_.wait(lock, [&] { return closed_ || messages_.empty() || bytes_ < most_bytes; });
        if (closed_ || is_outdated(message, oldest_)) return;
        bytes_ += message.bytes.size();
        messages_.push_back(std::move(message));
    }
    on_message_();
}

bool Outbox::take(Message& message) {
    const std::lock_guard lock(mutex_);
    if (messages_.empty()) return false;
    message = std::move(messages_.front());
    messages_.pop_front();
    bytes_ -= message.bytes.size();
    has_room_.notify_all();
    return true;
}

void Outbox::forget_before(std::uint32_t number) {
    const std::lock_guard lock(mutex_);
    oldest_ = number;
    std::erase_if(messages_, [&](const Message& message) {
        if (!is_outdated(message, number)) return false;
        bytes_ -= message.bytes.size();
        return true;
    });
    has_room_.notify_all();
}

void Outbox::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    messages_.clear();
    bytes_ = 0;
    has_room_.notify_all();
}

PageSession::PageSession(std::unique_ptr<StudioHome> home, std::function<void()> on_message,
                         std::function<void()> on_end)
    : home_(std::move(home)), outbox_(std::move(on_message)), on_end_(std::move(on_end)),
      session_(*home_, outbox_, [this] { wake(); }), thread_([this] { work(); }) {}

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
    constexpr std::chrono::seconds between_looks(1);
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, between_looks, [this] { return stopped_ || heard_; });
            if (stopped_) break;
            heard_ = false;
        }
        do
            session_.look_at_files();
        while (session_.work(budget_seconds));
    }
    home_->end_jobs(); // here, so that the server's thread does not wait for them
    on_end_();
}

} // namespace graftal
