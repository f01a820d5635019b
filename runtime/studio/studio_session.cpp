#include "runtime/studio/studio_session.h"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "compiler/session/stages.h"
#include "runtime/studio/asks.h"
#include "runtime/studio/binary_message.h"
#include "runtime/studio/files/file_asks.h"
#include "runtime/studio/message_reader.h"
#include "runtime/studio/model_message.h"
#include "runtime/studio/picture/clock.h"
#include "runtime/studio/text_asks.h"

namespace graftal {

namespace {

constexpr std::size_t most_message_bytes = 16u << 20u;
/// Asks, and faults, that wait for their answers.
constexpr std::size_t most_waiting = 256;
constexpr std::size_t most_waiting_bytes = 2 * most_message_bytes; // of all asks

/// Copies of a deep value would use up the stack.
nlohmann::json parsed(std::string_view message) {
    constexpr int deepest = 32;
    return nlohmann::json::parse(message,
                                 [](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
                                     if (depth > deepest)
                                         throw BadMessage("this message is nested too deeply");
                                     return true;
                                 });
}

nlohmann::json fault_message(const std::string& text) {
    return {{"type", "fault"}, {"text", text}};
}

/// Work for the rays of a thumbnail, and for the model that they go through, whatever it took to prepare
/// that: a sample a pixel of a dear model. Less would make its parts so coarse that all models look alike.
double thumbnail_seconds(ImageSize size) {
    constexpr double of_model = 1.5, of_pixel = 30e-6;
    return of_model + of_pixel * size.width * size.height;
}

} // namespace

StudioSession::StudioSession(StudioHome& home, StudioSink& sink, std::function<void()> wake)
    : home_(home), sink_(sink), wake_(std::move(wake)), laid_(home.files()),
      files_(laid_.files(), [this](const std::string& path) { used_[path] = laid_.files().stamp(path); }),
      pointer_(home, laid_.files(), CancelFlag([this] { return outdated(); })) {}

void StudioSession::hear(std::string_view message) {
    std::string problem;
    try {
        if (message.size() > most_message_bytes)
            throw BadMessage(fmt::format("a message has at most {} bytes", most_message_bytes));
        note(parsed(message), message.size());
        return;
    } catch (const nlohmann::json::exception& fault) {
        problem = fmt::format("this is no message: {}", fault.what());
    } catch (const BadMessage& fault) {
        problem = fault.what();
    }
    const std::lock_guard lock(inbox_);
    if (faults_.size() < most_waiting) faults_.push_back(std::move(problem));
    waiting_ = true;
}

void StudioSession::note(const nlohmann::json& message, std::size_t bytes) {
    const MessageReader fields(message);
    const std::string type = fields.needed_text("type");
    if (type == "state") {
        StudioState state = read_state(message, true);
        const std::lock_guard lock(inbox_);
        if (state.number <= newest_)
            throw BadMessage(fmt::format("state {} comes after state {}", state.number, newest_.load()));
        newest_ = state.number;
        // A state that nobody has taken has a text that this one may go without.
        if (!state.text && heard_) state.text = std::move(heard_->text);
        heard_ = std::move(state);
        stale_ = true;
    } else if (type == "ask") {
        Ask ask{static_cast<std::uint32_t>(fields.needed_whole("id", UINT32_MAX)), fields.needed_text("what"),
                message, bytes};
        if (ask.id < first_ask_id) throw BadMessage(fmt::format("'id' is at least {}", first_ask_id));
        const std::lock_guard lock(inbox_);
        if (asks_.size() >= most_waiting || asked_bytes_ + bytes > most_waiting_bytes)
            throw BadMessage("too many asks wait for an answer");
        asked_bytes_ += bytes;
        asks_.push_back(std::move(ask));
        waiting_ = true;
    } else {
        throw BadMessage(fmt::format("there is no message '{}'", type));
    }
}

void StudioSession::send(const nlohmann::json& message) {
    sink_.text(message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

bool StudioSession::work(double budget_seconds) {
    if (!std::exchange(greeted_, true)) {
        const OpenedModel opened = home_.opened();
        send({{"type", "hello"},
              {"version", home_.version()},
              {"home", home_.name()},
              {"engines", home_.engines()},
              {"formats", home_.formats()},
              {"name", opened.name},
              {"text", opened.text}});
    }
    const double end = clock_seconds() + budget_seconds;
    do {
        try {
            take_state();
            tell_of_file();
            tell_of_engine();
            if (answer_next()) continue;
            const double latest = clock_seconds() + patience_ * budget_seconds;
            const auto cut_short = [&] { return clock_seconds() > latest; };
            if (stage_ == Stage::compile)
                compile();
            else if (fitting_ && !draws_first())
                step_fit();
            else if (!thumbnails_.empty() && !draws_first())
                draw_thumbnail(cut_short);
            else if (stage_ == Stage::picture)
                draw(cut_short);
            else
                return false;
        } catch (const std::bad_alloc&) {
            fail("graftal has too little memory for this model: make it, or its picture, smaller");
        } catch (const std::exception& fault) { // a broken invariant
            fail(fault.what());
        }
    } while (!stopped_ && clock_seconds() < end);
    return !stopped_;
}

void StudioSession::fail(const std::string& why) {
    send(fault_message(why));
    stage_ = Stage::nothing;
    picture_.reset();
}

void StudioSession::take_state() {
    std::deque<std::string> faults;
    std::optional<StudioState> heard;
    {
        const std::lock_guard lock(inbox_);
        faults = std::exchange(faults_, {});
        heard = std::exchange(heard_, std::nullopt);
        stale_ = false;
        waiting_ = !asks_.empty();
    }
    for (const std::string& fault : faults)
        send(fault_message(fault));
    if (!heard) return;
    if (heard->name.empty()) heard->name = state_.name;
    if (!heard->text) heard->text = std::move(state_.text);
    state_ = *std::move(heard);
    stage_ = Stage::nothing;
    picture_ = nullptr;
    if (!state_.text || state_.name.empty()) {
        send(fault_message("the first state has no 'name' or no 'text'"));
        return;
    }
    confine_files(state_, home_);
    if (fitting_ && !fitting_->fit->is_about(state_)) end_fit("the model was changed meanwhile");
    if (laid_.lay(state_.files)) forget_files();
    stage_ = Stage::compile;
}

/// Has the stages read the files again that models name.
void StudioSession::forget_files() {
    if (model_.session) model_.session->reload(true);
    thumbnail_model_.session.reset();
    pointer_.forget_files();
    film_framing_ = {};
}

/// False after errors, or where the flag is raised.
bool StudioSession::prepare(ModelSession& model, StudioState& state, PreparedView& prepared,
                            Compilation& compilation) {
    if (!model.session || model.name != state.name) {
        model.session = std::make_unique<Session>(state.name, model.files);
        model.name = state.name;
        model.text = std::nullopt;
        home_.equip(*model.session);
        model.session->set_control({CancelFlag([this] { return outdated(); }), {}});
    }
    if (model.text != state.text) {
        model.session->edit(*state.text);
        model.text = state.text;
    }
    StageOptions& stages = state.stages;
    stages.lower.root = home_.root();
    stages.detail.memory_bytes = home_.memory_bytes();
    if (state.film) stages.view.framing = film_framing_.of(state, *model.session);
    if (outdated()) return false;
    prepared.viewed = model.session->viewed(stages, compilation);
    if (outdated() || !prepared.viewed) return false;
    compilation.status =
        home_.load_textures(prepared.viewed->model->graph, prepared.viewed->view, prepared.textures);
    if (!compilation.status.ok()) return false;
    prepared.detail = resolved(stages.detail, *prepared.viewed);
    prepared.prepared = model.session->prepared(stages, compilation);
    return !outdated() && prepared.prepared;
}

/// Has the stages read files again, if one that the model names changed.
bool StudioSession::reload_files() {
    const auto is_other = [&](const auto& used) { return laid_.files().stamp(used.first) != used.second; };
    if (!model_.session || std::ranges::none_of(used_, is_other)) return false;
    forget_files();
    return true;
}

void StudioSession::look_at_files() try {
    if (!reload_files() || stage_ == Stage::compile) return;
    picture_ = nullptr;
    stage_ = Stage::compile;
} catch (const std::bad_alloc&) { // the next look finds it again
}

void StudioSession::compile() {
    const bool is_same_text = model_.session && model_.name == state_.name && model_.text == state_.text;
    reload_files();
    compilation_ = {};
    PreparedView prepared;
    const Session* const session_before = model_.session.get();
    const std::uint64_t lowered_before = runs().lowered;
    std::map<std::string, FileStamp> used_before = std::exchange(used_, {});
    const bool is_drawn = prepare(model_, state_, prepared, compilation_);
    const bool is_read = model_.session.get() != session_before || runs().lowered != lowered_before;
    if (!is_read) used_ = std::move(used_before); // it has asked for none again
    if (outdated()) return;
    send(findings_message(state_.number, compilation_));
    const std::vector<std::string> engines = home_.engines();
    if (std::ranges::find(engines, state_.engine) == engines.end()) {
        send(fault_message(fmt::format("there is no engine '{}' here", state_.engine)));
        state_.engine = "native";
    }
    described_ = false;
    stage_ = is_drawn ? Stage::picture : Stage::nothing;
    if (!is_drawn) return;
    if (std::exchange(basis_of_, prepared.prepared) != prepared.prepared) basis_ = nullptr;
    picture_ = std::make_unique<ProgressivePicture>(
        std::move(prepared), PictureWishes{},
        [this]() -> const Workers& { return home_.workers(state_.threads); }, basis_,
        is_same_text ? seconds_a_sample_ : 0);
}

/// Whether the state's picture is not yet worth looking at.
bool StudioSession::draws_first() const {
    constexpr int enough = 2; // passes
    return stage_ == Stage::picture && !picture_->done() && picture_->passes() < enough;
}

/// A piece that was cut begins anew: the next one may take twice as long.
void StudioSession::wait_longer(bool was_cut) {
    patience_ = was_cut ? 2 * patience_ : 1;
}

void StudioSession::draw_thumbnail(const std::function<bool()>& cut_short) {
    try {
        step_thumbnail(cut_short);
    } catch (const std::bad_alloc&) {
        end_thumbnail("graftal has too little memory for this picture");
    } catch (const std::exception& fault) { // a broken invariant
        end_thumbnail(fault.what());
    }
}

void StudioSession::step_thumbnail(const std::function<bool()>& cut_short) {
    Thumbnail& thumbnail = thumbnails_.front();
    if (!thumbnail.picture) {
        Compilation compilation;
        PreparedView prepared;
        const bool is_drawn = prepare(thumbnail_model_, thumbnail.state, prepared, compilation);
        if (outdated()) return;
        if (!is_drawn) return end_thumbnail("this model has errors");
        constexpr int samples = 4;
        const double work_seconds =
            prepared.prepared->work_seconds + thumbnail_seconds(prepared.viewed->view.size);
        thumbnail.picture = std::make_unique<ProgressivePicture>(
            std::move(prepared), PictureWishes{.samples = samples, .work_seconds = work_seconds},
            [this]() -> const Workers& { return home_.workers(0); }, nullptr, 0, PicturePasses::last);
        return;
    }
    PictureListener listener;
    listener.on_tile = [&](ShownTile tile) { thumbnail.tiles.push_back(std::move(tile)); };
    listener.on_pass = [&](const ShownPass& shown) {
        if (!shown.done) thumbnail.tiles.clear();
    };
    thumbnail.picture->step([&] { return outdated() || cut_short(); }, [this] { return outdated(); },
                            listener);
    wait_longer(!outdated() && cut_short());
    if (thumbnail.picture->done()) end_thumbnail({});
}

void StudioSession::end_thumbnail(const std::string& error) {
    const Thumbnail thumbnail = std::move(thumbnails_.front());
    thumbnails_.pop_front();
    nlohmann::json message{{"type", "answer"}, {"id", thumbnail.id}};
    if (!error.empty()) message["error"] = error;
    for (const ShownTile& tile : thumbnail.tiles)
        sink_.binary(
            tile_message({thumbnail.id, static_cast<std::uint32_t>(tile.pass), tile.tile, tile.block},
                         home_.deflated(tile.rgb8)));
    send(message);
}

void StudioSession::describe() {
    if (std::exchange(described_, true)) return;
    Compilation compilation;
    const auto lowered = model_.session->lowered(state_.stages, compilation);
    const auto analysed = model_.session->analysed(state_.stages, compilation);
    if (!lowered || !analysed) return;
    send(model_message(state_, *lowered, *analysed, *picture_->prepared().viewed, compilation.sources));
}

void StudioSession::send_tile(const ShownTile& tile) {
    if (outdated()) return;
    sink_.binary(tile_message({state_.number, static_cast<std::uint32_t>(tile.pass), tile.tile, tile.block},
                              home_.deflated(tile.rgb8)));
}

/// Has another engine draw the state's picture.
void StudioSession::start_engine() {
    stage_ = Stage::nothing;
    engine_pass_ = picture_->passes();
    const std::uint32_t number = state_.number;
    const auto note = [this, number](std::optional<Image> picture, std::string error) {
        const std::lock_guard lock(inbox_);
        arrived_.push_back({number, std::move(picture), std::move(error)});
        if (wake_) wake_();
    };
    home_.draw_picture(
        {command_words(state_, "render"), {state_.name, *state_.text}, {}, ".png", state_.files},
        CancelFlag([this, number] { return stopped_ || newest_ != number; }),
        [note](const Image& developed) { note(developed, {}); },
        [note](std::string error) { note(std::nullopt, std::move(error)); });
}

void StudioSession::tell_of_engine() {
    std::deque<Arrived> arrived;
    {
        const std::lock_guard lock(inbox_);
        arrived = std::exchange(arrived_, {});
    }
    for (const Arrived& news : arrived) {
        if (news.number != state_.number || outdated()) continue;
        if (!news.error.empty()) send(fault_message(fmt::format("{}: {}", state_.engine, news.error)));
        if (news.picture)
            for (const ShownTile& tile : tiles_of_picture(*news.picture, engine_pass_))
                send_tile(tile);
        send({{"type", "pass"},
              {"number", state_.number},
              {"pass", news.picture ? engine_pass_++ : std::max(engine_pass_ - 1, 0)},
              {"samples", nullptr},
              {"seconds_left", nullptr},
              {"noise_255", nullptr},
              {"error_px", nullptr},
              {"whole_seconds", nullptr},
              {"done", !news.picture}});
    }
}

void StudioSession::draw(const std::function<bool()>& cut_short) {
    if (state_.engine != "native" && !picture_->is_rough()) return start_engine();
    PictureListener listener;
    listener.on_tile = [this](const ShownTile& shown) { send_tile(shown); };
    listener.on_pass = [this](const ShownPass& shown) {
        if (outdated()) return;
        send(pass_message(state_.number, shown));
    };
    const auto cancelled = [&] {
        if (outdated() || waiting_) return true;
        return cut_short();
    };
    const int passes = picture_->passes();
    if (!picture_->step(
            cancelled, [this] { return outdated(); }, listener))
        stage_ = Stage::nothing;
    wait_longer(!outdated() && !waiting_ && cut_short());
    basis_ = picture_->basis();
    seconds_a_sample_ = picture_->rough_seconds_a_sample();
    if (picture_->passes() > 0 && passes == 0 && !outdated()) describe();
}

bool StudioSession::answer_next() {
    // Asks are about the last state.
    if (stage_ == Stage::compile) return false;
    Ask ask;
    {
        const std::lock_guard lock(inbox_);
        if (asks_.empty()) return false;
        ask = std::move(asks_.front());
        asks_.pop_front();
        asked_bytes_ -= ask.bytes;
        waiting_ = !asks_.empty();
    }
    nlohmann::json message{{"type", "answer"}, {"id", ask.id}};
    try {
        if (ask.what == "write" || ask.what == "thumbnail" || ask.what == "fit") {
            if (!state_.text) throw BadMessage("no state was sent");
            if (ask.what == "write")
                start_file(ask);
            else if (ask.what == "fit")
                start_fit(ask);
            else
                thumbnails_.push_back(thumbnail_of(ask));
            return true;
        }
        if (ask.what == "stop")
            stop_job(ask);
        else
            message.update(answer(ask));
    } catch (const std::bad_alloc&) {
        message["error"] = "graftal has too little memory for an answer";
    } catch (const std::exception& fault) { // BadMessage, or a broken invariant
        message["error"] = fault.what();
    }
    send(message);
    return true;
}

StudioSession::Thumbnail StudioSession::thumbnail_of(const Ask& ask) const {
    constexpr std::size_t most_thumbnails = 64;
    constexpr int most_side = 1024;
    if (thumbnails_.size() >= most_thumbnails) throw BadMessage("too many thumbnails wait");
    Thumbnail thumbnail{ask.id, read_state(ask.message, false), nullptr, {}};
    StudioState& state = thumbnail.state;
    if (std::max(state.stages.view.size.width, state.stages.view.size.height) > most_side)
        throw BadMessage(fmt::format("a thumbnail has at most {} pixels along a side", most_side));
    if (state.name.empty()) state.name = state_.name;
    if (!state.text) state.text = state_.text;
    return thumbnail;
}

/// Has the home make a file. The answer comes when it is made.
void StudioSession::start_file(const Ask& ask) {
    FileJob job = file_job(state_, ask.message);
    {
        const std::lock_guard lock(inbox_);
        if (writing_) throw BadMessage("another file is being made");
        writing_ = Writing{.id = ask.id, .share = {}, .told = {}, .result = {}};
        file_stopped_ = false;
    }
    const auto note = [this](const auto& change) {
        const std::lock_guard lock(inbox_);
        if (writing_) change(*writing_);
        if (wake_) wake_();
    };
    try {
        home_.make_file(
            std::move(job), CancelFlag([this] { return stopped_ || file_stopped_; }),
            [note](const FileShare& share) { note([&](Writing& writing) { writing.share = share; }); },
            [note](FileResult result) {
                note([&](Writing& writing) { writing.result = std::move(result); });
            });
    } catch (...) { // no memory, or no thread: it was not begun
        const std::lock_guard lock(inbox_);
        writing_.reset();
        throw;
    }
}

void StudioSession::tell_of_file() {
    std::optional<Writing> writing;
    {
        const std::lock_guard lock(inbox_);
        if (!writing_ || (!writing_->result && !is_news(writing_->share, writing_->told))) return;
        writing_->told = writing_->share;
        writing = writing_->result ? std::exchange(writing_, std::nullopt) : writing_;
    }
    if (!writing->result) return send(progress_message(writing->id, writing->share));
    const FileResult& result = *writing->result;
    nlohmann::json message{{"type", "answer"}, {"id", writing->id}};
    if (!result.error.empty())
        message["error"] = result.error;
    else if (!result.path.empty())
        message["path"] = result.path;
    else
        sink_.binary(
            file_message(writing->id, result.name.size(), home_.deflated(result.name + result.contents)));
    send(message);
}

} // namespace graftal
