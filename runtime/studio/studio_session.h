#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "compiler/support/files.h"
#include "runtime/studio/files/linked_files.h"
#include "runtime/studio/film_framing.h"
#include "runtime/studio/picture/progressive_picture.h"
#include "runtime/studio/pointer.h"
#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_state.h"
#include "runtime/studio/text_fit.h"

namespace graftal {

/// One page's model: hears its messages, and does the work that they ask for, piece by piece
/// (docs/studio.md). It knows no operating system; its home does.
///
/// One thread calls work(); another may call hear() and stop() at any time. With one thread for all, work()
/// returns after its budget, or some pieces later where a piece is long.
class StudioSession {
    /// The stages of one model, and the text that they know.
    struct ModelSession {
        const Files& files;
        std::unique_ptr<Session> session = nullptr;
        std::string name = {};
        std::optional<std::string> text = {};
    };

  public:
    /// Home and sink outlive it. `wake`: called by any thread when work() has something to do that nobody
    /// said.
    StudioSession(StudioHome& home, StudioSink& sink, std::function<void()> wake = {});
    ~StudioSession() {
        stop();
        home_.end_jobs();
    }
    StudioSession(const StudioSession&) = delete;
    StudioSession& operator=(const StudioSession&) = delete;

    /// Notes a message. Work on a state before it ends soon; answers come from work().
    void hear(std::string_view message);

    /// Works for about so many seconds; the last piece of work may take as long again. False when there is
    /// nothing to do until the next message.
    bool work(double budget_seconds);

    /// Has work() compile and draw the last state anew where a file that its model names was written, came or
    /// went since. Called by the thread that works.
    void look_at_files();

    /// Ends all work soon, and for good.
    void stop() { stopped_ = true; }

    /// Number of the newest state that was heard; 0 before the first.
    std::uint32_t newest() const { return newest_; }

    StageRuns runs() const { return model_.session ? model_.session->runs() : StageRuns{}; }
    /// Passes of the last state's picture that are complete.
    int passes() const { return picture_ ? picture_->passes() : 0; }

  private:
    enum class Stage { nothing, compile, picture };

    struct Ask {
        std::uint32_t id = 0;
        std::string what;
        nlohmann::json message;
        std::size_t bytes = 0; ///< of the message
    };

    /// A file that is made, or was.
    struct Writing {
        std::uint32_t id = 0;
        FileShare share, told;
        std::optional<FileResult> result;
    };

    /// Maps that are fitted to a target.
    struct Fitting {
        std::uint32_t id = 0;
        std::unique_ptr<TextFit> fit;
        FileShare told; ///< of the stage "fit"
        bool stopped = false;
    };

    /// A small picture of another state.
    struct Thumbnail {
        std::uint32_t id = 0;
        StudioState state; ///< with its text
        std::unique_ptr<ProgressivePicture> picture;
        std::vector<ShownTile> tiles; ///< of the pass under way
    };

    /// News of an engine that draws beside the session: a picture, or its end.
    struct Arrived {
        std::uint32_t number = 0; ///< of the state
        std::optional<Image> picture;
        std::string error;
    };

    // For hear().
    void note(const nlohmann::json& message, std::size_t bytes);

    // For work().
    void take_state();
    void forget_files();
    bool answer_next();
    Thumbnail thumbnail_of(const Ask& ask) const;
    void stop_job(const Ask& ask);
    void start_file(const Ask& ask);
    void tell_of_file();
    void start_engine();
    void tell_of_engine();
    void send_tile(const ShownTile& tile);
    bool draws_first() const;
    void wait_longer(bool was_cut);
    void draw_thumbnail(const std::function<bool()>& cut_short);
    void step_thumbnail(const std::function<bool()>& cut_short);
    void end_thumbnail(const std::string& error);
    bool prepare(ModelSession& model, StudioState& state, PreparedView& prepared, Compilation& compilation);
    bool reload_files();
    void compile();
    void describe();
    void draw(const std::function<bool()>& cut_short);
    void fail(const std::string& why);
    nlohmann::json answer(const Ask& ask);
    template<typename Answer> nlohmann::json about_text(const CancelFlag& cancel, const Answer& answer);
    nlohmann::json answer_text(const Ask& ask);
    void start_fit(const Ask& ask);
    void step_fit();
    void end_fit();
    void end_fit(const std::string& error);
    void send(const nlohmann::json& message);
    bool outdated() const { return stale_ || stopped_; }

    StudioHome& home_;
    StudioSink& sink_;
    std::function<void()> wake_;
    bool greeted_ = false;

    std::mutex inbox_;
    std::optional<StudioState> heard_;
    std::deque<Ask> asks_;
    std::size_t asked_bytes_ = 0; ///< of all of these
    std::deque<std::string> faults_;
    std::optional<Writing> writing_;
    std::deque<Arrived> arrived_;
    std::atomic<std::uint32_t> newest_ = 0;
    std::atomic<bool> stale_ = false;   ///< a newer state was heard
    std::atomic<bool> waiting_ = false; ///< asks or faults were heard
    std::atomic<bool> stopped_ = false;
    std::atomic<bool> file_stopped_ = false; ///< nobody wants the file any more

    Stage stage_ = Stage::nothing;
    StudioState state_;                     ///< with its text
    std::map<std::string, FileStamp> used_; ///< files that the model names, there or not, when it was read
    LaidFiles laid_;
    const HeardFiles files_; ///< that note them
    ModelSession model_{files_};
    ModelSession thumbnail_model_{laid_.files()};
    std::deque<Thumbnail> thumbnails_;
    std::optional<Fitting> fitting_;
    Compilation compilation_; ///< of the state
    std::unique_ptr<ProgressivePicture> picture_;
    Pointer pointer_;
    FilmFraming film_framing_;
    std::shared_ptr<TraceBasis> basis_; ///< of the last picture
    std::shared_ptr<const PreparedGraph> basis_of_;
    bool described_ = false;      ///< the state's model was told
    int engine_pass_ = 0;         ///< of the engine that draws beside this
    double seconds_a_sample_ = 0; ///< of the last picture of this text
    double patience_ = 1;         ///< budgets that the next piece may take
};

} // namespace graftal
