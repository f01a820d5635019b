// The face of a session for a worker of a page: what the module graftal_studio.wasm exports, and what it asks
// for (post.js).

#include <cstddef>

#include <emscripten.h>

#include "runtime/studio/example.h"
#include "runtime/studio/studio_session.h"

extern "C" {
/// Has the worker post a message: bytes of JSON, or a binary one.
void graftal_post(bool is_binary, const char* bytes, std::size_t size);
}

namespace graftal {
namespace {

class WorkerHome final : public StudioHome {
  public:
    std::string name() const override { return "browser"; }
    std::string version() const override { return GRAFTAL_VERSION; }
    OpenedModel opened() const override { return example_model(); }
    const Files& files() const override { return files_; }
    const Workers& workers(int) override { return alone_; }
    std::uint64_t memory_bytes() const override {
        // The module's memory ends at 1 GiB (cmake/studio_web.cmake), and holds texts and pictures too.
        return std::uint64_t{640} << 20;
    }

    MemoryFiles files_;

  private:
    SerialWorkers alone_;
};

class WorkerSink final : public StudioSink {
  public:
    void text(const std::string& message) override { graftal_post(false, message.data(), message.size()); }
    void binary(const std::string& message) override { graftal_post(true, message.data(), message.size()); }
};

struct Studio {
    WorkerHome home;
    WorkerSink sink;
    StudioSession session{home, sink};
};

/// The one of this module.
Studio& studio() {
    static Studio instance;
    return instance;
}

} // namespace
} // namespace graftal

extern "C" {

/// StudioSession::hear().
EMSCRIPTEN_KEEPALIVE void graftal_hear(const char* message, std::size_t size) {
    graftal::studio().session.hear({message, size});
}

/// StudioSession::work().
EMSCRIPTEN_KEEPALIVE bool graftal_work(double budget_seconds) {
    return graftal::studio().session.work(budget_seconds);
}

/// Puts a text where models find it by its path.
EMSCRIPTEN_KEEPALIVE void graftal_put_file(const char* path, const char* text, std::size_t size) {
    graftal::studio().home.files_.set(path, {text, size});
}
}
