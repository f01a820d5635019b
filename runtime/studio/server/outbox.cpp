#include "runtime/studio/server/outbox.h"

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

} // namespace graftal
