#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "compiler/editing/document.h"
#include "compiler/session/stage_options.h"
#include "compiler/support/control.h"
#include "compiler/support/files.h"
#include "runtime/render/picture_session.h"

namespace graftal {

/// A server of the Language Server Protocol (3.17) for one editor: diagnostics, completion, hover,
/// definition, rename, formatting, symbols. Messages come in one by one; it answers questions at once, and
/// looks at changed texts when it is told to work. Used by one thread at a time.
class LanguageServer {
  public:
    /// Takes the JSON of a message to the editor.
    using Send = std::function<void(const std::string& message)>;

    /// More open texts, or longer ones, are refused.
    static constexpr std::size_t most_texts = 64;
    static constexpr std::size_t most_text_bytes = std::size_t{16} << 20;

    /// `files`: of the machine; open texts lie over them. They outlive it, and so does what `send` needs.
    LanguageServer(const Files& files, Send send);
    ~LanguageServer();
    LanguageServer(const LanguageServer&) = delete;
    LanguageServer& operator=(const LanguageServer&) = delete;

    /// Takes the JSON of a message, any bytes at all.
    void receive(const std::string& message);
    /// Whether some text is to be looked at.
    bool has_work() const;
    /// Looks at one text, and publishes its findings. A raised flag ends that early: the text stays to be
    /// looked at.
    void work(const CancelFlag& cancel);

    /// The editor has said goodbye.
    bool ended() const { return ended_; }
    /// The exit status of the process: 0 after `shutdown` and `exit`, else 1.
    int exit_status() const { return shut_down_ ? 0 : 1; }

  private:
    struct OpenText;
    class Handlers;

    MemoryFiles files_;
    Send send_;
    std::map<std::string, std::unique_ptr<OpenText>> texts_; ///< by URI
    bool initialised_ = false;
    bool shut_down_ = false;
    bool ended_ = false;
};

} // namespace graftal
