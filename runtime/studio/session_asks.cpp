// Answers of a session to its asks, and the fit that an ask begins.

#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "compiler/session/stages.h"
#include "runtime/studio/asks.h"
#include "runtime/studio/files/linked_files.h"
#include "runtime/studio/message_reader.h"
#include "runtime/studio/model_message.h"
#include "runtime/studio/studio_session.h"
#include "runtime/studio/text_asks.h"

namespace graftal {

namespace {

/// Factor of one ask for a zoom.
constexpr double least_factor = 1e-3;

} // namespace

/// Asks `answer` about the state's text. `cancel`: of the analyses that it asks for.
template<typename Answer>
nlohmann::json StudioSession::about_text(const CancelFlag& cancel, const Answer& answer) {
    Compilation unheard; // its findings were told
    const bool is_whole = !compilation_.diagnostics.has_errors() && model_.session;
    const auto lowered = is_whole ? model_.session->lowered(state_.stages, unheard) : nullptr;
    const auto analysed = lowered ? model_.session->analysed(state_.stages, unheard) : nullptr;
    StageWork work = stage_work(state_.stages);
    EditContext context;
    context.lower = state_.stages.lower;
    context.help.control = {cancel, {}, &work};
    context.help.translator = home_.translator();
    context.help.files = &laid_.files();
    return answer(AskedText{state_, analysed.get(), lowered ? &lowered->notes.parameters : nullptr, context});
}

nlohmann::json StudioSession::answer_text(const Ask& ask) {
    return about_text(CancelFlag([this] { return outdated(); }), [&](const AskedText& asked) {
        return answer_about_text(ask.what, ask.message, asked);
    });
}

void StudioSession::start_fit(const Ask& ask) {
    if (fitting_) throw BadMessage("another fit is under way");
    about_text(CancelFlag([this] { return stopped_.load(); }), [&](const AskedText& asked) {
        fitting_ = Fitting{ask.id, std::make_unique<TextFit>(ask.message, asked), {"fit", 0}};
        return nlohmann::json();
    });
}

/// A view that moves meanwhile does not end it.
void StudioSession::step_fit() try {
    Fitting& fitting = *fitting_;
    const bool goes_on = !fitting.stopped &&
                         fitting.fit->step(home_.workers(0), CancelFlag([this] { return stopped_.load(); }));
    const FileShare share{"fit", fitting.fit->share()};
    if (is_news(share, fitting.told)) send(progress_message(fitting.id, share));
    fitting.told = share;
    if (!goes_on) end_fit();
} catch (const std::bad_alloc&) {
    end_fit("graftal has too little memory for this fit");
} catch (const std::exception& fault) { // BadMessage, or a broken invariant
    end_fit(fault.what());
}

/// Answers with the best maps so far.
void StudioSession::end_fit() {
    nlohmann::json message{{"type", "answer"}, {"id", fitting_->id}};
    message.update(about_text(CancelFlag([this] { return stopped_.load(); }),
                              [&](const AskedText& asked) { return fitting_->fit->answer(asked); }));
    fitting_.reset();
    send(message);
}

void StudioSession::end_fit(const std::string& error) {
    send({{"type", "answer"}, {"id", fitting_->id}, {"error", error}});
    fitting_.reset();
}

nlohmann::json StudioSession::answer(const Ask& ask) {
    if (!state_.text) throw BadMessage("no state was sent");
    const MessageReader fields(ask.message);
    if (is_about_text(ask.what)) return answer_text(ask);
    if (ask.what == "link") {
        // A model may name files that are none of its kind: only where it is whole do their texts go out.
        const bool is_whole = compilation_.status.ok() && !compilation_.diagnostics.has_errors();
        return link_parts(state_, used_, is_whole ? laid_.files() : no_files());
    }
    if (ask.what == "open")
        return opened_link(ask.message, home_, CancelFlag([this] { return stopped_.load(); }));
    pointer_.look_at(state_);
    if (ask.what == "pick") return pointer_.pick(fields.needed_number("x"), fields.needed_number("y"));
    if (ask.what == "zoom") {
        const double factor = fields.needed_number("factor");
        if (!(factor >= least_factor && factor <= 1 / least_factor))
            throw BadMessage("'factor' is out of range");
        return pointer_.zoom({fields.needed_number("x"), fields.needed_number("y"),
                              fields.number("dx").value_or(0), fields.number("dy").value_or(0), factor});
    }
    if (ask.what == "command") {
        const nlohmann::json* const film = fields.object("film");
        return {
            {"command", command_line(film ? film_words(state_, *film) : command_words(state_, "render"))}};
    }
    throw BadMessage(fmt::format("there is no ask '{}'", ask.what));
}

/// Ends the fit of this number; without one, the file.
void StudioSession::stop_job(const Ask& ask) {
    const auto number = MessageReader(ask.message).whole("number", UINT32_MAX);
    if (!number)
        file_stopped_ = true;
    else if (fitting_ && fitting_->id == *number)
        fitting_->stopped = true;
}

} // namespace graftal
