#include <array>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <unistd.h>

#include "runtime/lsp/language_server.h"
#include "runtime/lsp/message_stream.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// Messages that came in and were not taken. An editor that sends faster than that waits.
constexpr std::size_t most_waiting = 1000;

/// Reads standard input on a thread of its own, so that a message that comes in can end work.
class Inbox {
  public:
    Inbox() : reader_([this] { read(); }) {}
    Inbox(const Inbox&) = delete;
    Inbox& operator=(const Inbox&) = delete;

    bool has_messages() {
        const std::lock_guard lock(mutex_);
        return !messages_.empty() || closed_;
    }
    /// Waits for a message; nothing at the end of the input.
    std::optional<std::string> wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !messages_.empty() || closed_; });
        if (messages_.empty()) return std::nullopt;
        std::string message = std::move(messages_.front());
        messages_.pop_front();
        changed_.notify_all();
        return message;
    }
    std::string fault() {
        const std::lock_guard lock(mutex_);
        return stream_.fault();
    }

  private:
    void read() {
        std::array<char, 1 << 16> bytes{};
        while (true) {
            const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            std::unique_lock lock(mutex_);
            if (count > 0) stream_.add({bytes.data(), static_cast<std::size_t>(count)});
            while (auto message = stream_.next())
                messages_.push_back(std::move(*message));
            closed_ = count <= 0 || !stream_.fault().empty();
            changed_.notify_all();
            if (closed_) return;
            changed_.wait(lock, [this] { return messages_.size() < most_waiting; });
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    MessageStream stream_;
    std::deque<std::string> messages_;
    bool closed_ = false;
    std::thread reader_; ///< the last, for it uses all the others
};

} // namespace

int run_lsp(const Options&) {
    // The thread waits for bytes that may never come: it ends with the process, and needs this until then.
    static Inbox* const inbox = new Inbox;
    Status written;
    LanguageServer server(disk_files(), [&](const std::string& message) {
        if (written.ok()) written = write_text("-", framed(message));
    });
    const CancelFlag more([] { return inbox->has_messages(); });
    while (!server.ended() && written.ok()) {
        while (server.has_work() && !inbox->has_messages())
            server.work(more);
        const std::optional<std::string> message = inbox->wait();
        if (!message) break;
        server.receive(*message);
    }
    if (!written.ok()) return complain(written.message()), exit_environment;
    if (const std::string fault = inbox->fault(); !fault.empty()) complain("lsp: " + fault);
    return server.exit_status();
}

} // namespace graftal
