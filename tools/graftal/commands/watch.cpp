#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>

#include "compiler/import/importers.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file_watch.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

/// A save may be several changes: it is over when nothing has changed for so long, or when it never ends.
constexpr std::chrono::milliseconds quiet_time{50}, longest_save{1000};

/// "leaf.inst, bark.png and 3 more"
std::string names_text(const std::set<std::string>& names) {
    constexpr std::size_t most = 3;
    const auto end = std::next(names.begin(), static_cast<std::ptrdiff_t>(std::min(names.size(), most)));
    const std::string text = fmt::format("{}", fmt::join(names.begin(), end, ", "));
    return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

/// Draws a model whenever it, or a file that it names, changes.
class Watching {
  public:
    explicit Watching(const Options& options)
        : options_(options), render_(options.render), bar_(!options.quiet),
          watched_(disk_files(), [this](const std::string& path) { watch(path); }),
          session_(options, options.operands.front(), Keep::everything, watched_) {
        const CancelFlag interrupted = interruption_.flag();
        session_.set_control(
            {CancelFlag([this, interrupted] { return interrupted.raised() || files_.changed(); }), {}});
        render_.progressive = options.progressive.value_or(true);
        render_.on_progress = [this](const DrawProgress& progress) { bar_.show(progress); };
    }

    int run() {
        watch(model_path(options_.operands.front()).file);
        if (const Status status = check_writable(render_.output); !status.ok()) {
            complain(status.message());
            return exit_environment;
        }
        Status status = files_.status();
        while (status.ok() && interruption_.signal() == 0) {
            look();
            status = wait_for_change();
        }
        const int signal = interruption_.signal();
        complain(signal != 0 ? "interrupted" : status.message());
        return signal != 0 ? 128 + signal : exit_environment;
    }

  private:
    /// A model may use the picture that is drawn of it; without an end, if that counted as a change.
    void watch(const std::string& path) {
        uses_.push_back(path);
        if (!same_place(path, render_.output)) files_.add(path);
    }

    /// Draws what there is. Says nothing of a picture that a change makes useless: the next one follows.
    void look() {
        try {
            draw();
        } catch (const std::bad_alloc& fault) {
            bar_.clear();
            conclude_out_of_memory(fault);
            conclude(std::nullopt);
        }
    }

    void draw() {
        Compilation compilation;
        const std::uint64_t lowered_before = session_.runs().lowered;
        if (lowered_before > 0) session_.reload();
        bar_.show("compiling...");
        std::optional<DrawReport> drawn;
        std::vector<std::string> used = std::exchange(uses_, {});
        bool compiled = options_.engine->compile(session_, render_.compile, compilation);
        if (session_.runs().lowered == lowered_before) uses_ = std::move(used); // it has asked for none again
        compiled = compiled && !refuse_own_file(options_, uses_, compilation);
        const bool same = compiled && settled_ && session_.runs().lowered == lowered_before;
        if (compiled && !same) drawn = options_.engine->draw(session_, render_, compilation);
        bar_.clear();
        const bool interrupted = interruption_.signal() != 0;
        if (interrupted) compilation.status = Status();
        const bool changed_since = !same && files_.changed() && !interrupted;
        if (!changed_since && !same) {
            print_findings(options_, compilation);
            conclude(drawn);
        }
        if (same) changed_.clear();
        settled_ = !changed_since;
    }

    /// The line about a picture, or about why there is none.
    void conclude(const std::optional<DrawReport>& drawn) {
        std::string line = changed_.empty() ? "" : names_text(changed_) + " changed: ";
        changed_.clear();
        if (drawn)
            line += fmt::format("{}: {}", render_.output, drawn->summary);
        else
            line += fmt::format("no new {}; graftal waits for a change", render_.output);
        if (!options_.quiet && (drawn || interruption_.signal() == 0)) say(line + "\n");
    }

    /// Until a save is over, or a signal comes. Fails where files cannot be watched.
    Status wait_for_change() {
        Status status = files_.status();
        if (status.ok()) status = wait(-1);
        const auto longest = std::chrono::steady_clock::now() + longest_save;
        while (status.ok() && files_.changed()) {
            for (std::string& file : files_.take())
                changed_.insert(std::move(file));
            if (std::chrono::steady_clock::now() > longest) break;
            status = wait(static_cast<int>(quiet_time.count()));
        }
        return status.ok() ? files_.status() : status;
    }

    /// Waits until a file has changed, a signal comes or `most_ms` milliseconds are over; -1: for ever.
    Status wait(int most_ms) const {
        std::array<pollfd, 2> wanted = {
            {{files_.descriptor(), POLLIN, 0}, {interruption_.flag().wake_descriptor(), POLLIN, 0}}};
        int ready = -1;
        do
            ready = ::poll(wanted.data(), wanted.size(), most_ms);
        while (ready < 0 && errno == EINTR && interruption_.signal() == 0);
        if (ready >= 0 || errno == EINTR) return {};
        return Status::failure(fmt::format("cannot wait for changes of files: {}", std::strerror(errno)));
    }

    const Options& options_;
    RenderOptions render_;
    ProgressBar bar_;
    const Interruption interruption_;
    FileWatch files_;
    std::vector<std::string> uses_; ///< the model, and the files that it names
    const HeardFiles watched_;      ///< the model's files
    CommandSession session_;
    std::set<std::string> changed_; ///< since the last line
    bool settled_ = false;          ///< the last picture is that of the model as the session knows it
};

} // namespace

int run_watch(const Options& options) {
    return Watching(options).run();
}

} // namespace graftal
