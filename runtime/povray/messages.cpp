#include "runtime/povray/messages.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

namespace graftal {

namespace {

constexpr std::size_t longest_line = 1 << 16;
constexpr std::size_t kept_lines = 8;
/// POV-Ray breaks its lines at a blank before this column, or right there in a word without blanks.
constexpr std::size_t console_width = 79;

/// If `text` starts with `prefix`, drops it.
bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return false;
    text.remove_prefix(prefix.size());
    return true;
}

template<typename Number> std::optional<Number> take_number(std::string_view& text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

std::string_view without_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// "File 'NAME' line N: " in front of a message.
void take_place(std::string_view& text, PovrayMessage& message) {
    std::string_view rest = text;
    if (!take(rest, "File '")) return;
    const std::size_t end = rest.find("' line ");
    if (end == std::string_view::npos) return;
    const std::string_view file = rest.substr(0, end);
    rest.remove_prefix(end + std::string_view("' line ").size());
    const std::optional<int> line = take_number<int>(rest);
    if (!line || !take(rest, ": ")) return;
    message.file = file;
    message.line = *line;
    text = rest;
}

constexpr std::pair<std::string_view, PovrayMessage::Kind> message_words[] = {
    {"Parse Error: ", PovrayMessage::Kind::error},
    {"Possible Parse Error: ", PovrayMessage::Kind::possible_error},
    {"Parse Warning: ", PovrayMessage::Kind::warning},
    {"Warning: ", PovrayMessage::Kind::warning},
    {"Fatal error in ", PovrayMessage::Kind::error},
};

bool starts_message(std::string_view line) {
    PovrayMessage ignored;
    take_place(line, ignored);
    return std::any_of(std::begin(message_words), std::end(message_words),
                       [&](const auto& word) { return line.starts_with(word.first); });
}

/// "  Parse Time:       0 hours  0 minutes  3 seconds (3.298 seconds)": the number in brackets.
std::optional<double> seconds_in(std::string_view line) {
    const std::size_t bracket = line.find('(');
    if (bracket == std::string_view::npos) return std::nullopt;
    line.remove_prefix(bracket + 1);
    const std::optional<double> seconds = take_number<double>(line);
    return seconds && line.starts_with(" seconds)") ? seconds : std::nullopt;
}

} // namespace

PovrayMessageReader::PovrayMessageReader(std::function<void(const PovrayProgress&)> on_progress)
    : on_progress_(std::move(on_progress)) {}

void PovrayMessageReader::feed(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = text.find_first_of("\r\n");
        const std::size_t room = longest_line - partial_.size();
        partial_.append(text.substr(0, std::min(end, room)));
        if (end == std::string_view::npos) return;
        read_line(std::exchange(partial_, {}));
        text.remove_prefix(end + 1);
    }
}

void PovrayMessageReader::finish() {
    if (!partial_.empty()) read_line(std::exchange(partial_, {}));
    close_message();
}

void PovrayMessageReader::read_line(std::string_view line) {
    if (continues_message(line)) {
        if (pending_->size() < longest_line) pending_->append(line);
        last_length_ = line.size();
        return;
    }
    close_message();
    if (line.empty() || read_progress(line)) return;
    if (starts_message(line)) {
        pending_ = line;
        last_length_ = line.size();
        return;
    }
    read_statistics(line);
    if (log_.last_lines.size() == kept_lines) log_.last_lines.erase(log_.last_lines.begin());
    log_.last_lines.emplace_back(line);
}

bool PovrayMessageReader::continues_message(std::string_view line) const {
    if (!pending_ || line.empty()) return false;
    return line.front() == ' ' || (last_length_ >= console_width && !starts_message(line));
}

void PovrayMessageReader::close_message() {
    if (!pending_) return;
    const std::string text = *std::exchange(pending_, std::nullopt);
    log_.illegal_matrix |= text.find("Illegal matrix column") != std::string::npos;
    log_.no_objects |= text.find("No objects in scene") != std::string::npos;
    read_message(text);
}

void PovrayMessageReader::read_message(std::string_view text) {
    PovrayMessage message;
    take_place(text, message);
    for (const auto& [word, kind] : message_words) {
        if (!text.starts_with(word)) continue;
        if (!word.starts_with("Fatal")) text.remove_prefix(word.size());
        message.kind = kind;
        message.text = without_blanks(text);
        return keep(std::move(message));
    }
}

void PovrayMessageReader::keep(PovrayMessage message) {
    std::vector<PovrayMessage>& kept = log_.messages;
    if (kept.size() == PovrayLog::max_messages) {
        const auto lesser = std::find_if(kept.rbegin(), kept.rend(), [&](const PovrayMessage& other) {
            return other.kind < message.kind;
        });
        if (lesser == kept.rend()) return;
        kept.erase(std::prev(lesser.base()));
    }
    kept.push_back(std::move(message));
}

bool PovrayMessageReader::read_progress(std::string_view line) {
    using Stage = PovrayProgress::Stage;
    if (take(line, "@@")) {
        const std::optional<int> percent = take_number<int>(line);
        if (!percent || *percent < 0 || *percent > 100) return false;
        // After the last mark POV-Ray builds its bounding slabs, and says nothing while it does.
        if (*percent == 100)
            report({Stage::bounding, std::nullopt});
        else
            report({Stage::parsing, *percent / 100.0});
        return true;
    }
    if (line.starts_with("==== [Parsing...]") || (line.starts_with("Parsing ") && line.ends_with("tokens"))) {
        // A count of tokens has no known end: it says less than the marks do.
        if (!reported_) report({Stage::parsing, std::nullopt});
        return true;
    }
    if (line.starts_with("==== [Rendering...]")) {
        report({Stage::rendering, 0.0});
        return true;
    }
    if (!take(line, "Rendered ")) return false;
    const std::optional<std::uint64_t> done = take_number<std::uint64_t>(line);
    if (!done || !take(line, " of ")) return false;
    const std::optional<std::uint64_t> all = take_number<std::uint64_t>(line);
    if (!all || *all == 0 || !line.starts_with(" pixels")) return false;
    report({Stage::rendering, std::min(1.0, static_cast<double>(*done) / static_cast<double>(*all))});
    return true;
}

void PovrayMessageReader::report(PovrayProgress progress) {
    if (reported_ == progress) return;
    reported_ = progress;
    if (on_progress_) on_progress_(progress);
}

void PovrayMessageReader::read_statistics(std::string_view line) {
    const std::string_view text = without_blanks(line);
    if (text == "POV-Ray finished") log_.finished = true;
    const std::pair<std::string_view, std::optional<double>*> times[] = {
        {"Parse Time:", &log_.parse_seconds},
        {"Bounding Time:", &log_.bounding_seconds},
        {"Trace Time:", &log_.trace_seconds},
    };
    for (const auto& [label, seconds] : times)
        if (text.starts_with(label)) *seconds = seconds_in(text);
    std::string_view rest = text;
    if (!take(rest, "Finite Objects:")) return;
    rest = without_blanks(rest);
    log_.finite_objects = take_number<std::uint64_t>(rest);
}

} // namespace graftal
