#include "compiler/support/diagnostics.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/support/printable.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

constexpr std::size_t widest_excerpt = 160;
/// More names than fit here would hide the message among them.
constexpr std::size_t longest_list = 200;
constexpr std::size_t longest_message = 1000;

std::size_t code_points(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string place(const SourceMap& sources, Span span) {
    if (!span.known()) return "graftal";
    const Position at = sources.position(span.file, span.begin);
    return fmt::format("{}:{}:{}", escaped(sources.name(span.file)), at.line, at.column);
}

void append_excerpt(std::string& out, const SourceMap& sources, Span span) {
    if (!span.known()) return;
    const Position at = sources.position(span.file, span.begin);
    const std::string_view line = sources.line(span.file, at.line);
    const auto line_begin = static_cast<std::uint32_t>(line.data() - sources.text(span.file).data());
    std::size_t first = std::min<std::size_t>(span.begin - line_begin, line.size());
    std::size_t last = std::min<std::size_t>(std::max(span.end, span.begin) - line_begin, line.size());

    // A very long line is shown as a window around the caret.
    std::size_t window_begin = 0;
    if (line.size() > widest_excerpt) {
        window_begin = first > widest_excerpt / 2 ? first - widest_excerpt / 2 : 0;
        while (window_begin < first && (line[window_begin] & 0xC0) == 0x80)
            ++window_begin;
    }
    std::size_t window_end = std::min(window_begin + widest_excerpt, line.size());
    while (window_end < line.size() && window_end > first && (line[window_end] & 0xC0) == 0x80)
        --window_end;
    const std::string_view window = line.substr(window_begin, window_end - window_begin);
    first -= window_begin;
    last = std::clamp(last - window_begin, first, window.size());
    const std::size_t indent = code_points(window.substr(0, first));
    const std::size_t width = std::max<std::size_t>(1, code_points(window.substr(first, last - first)));
    out += fmt::format("    {}\n    {}^{}\n", masked(window), std::string(indent, ' '),
                       std::string(width - 1, '~'));
}

} // namespace

const char* name_of(Severity severity) {
    switch (severity) {
    case Severity::error:
        return "error";
    case Severity::warning:
        return "warning";
    case Severity::note:
        break;
    }
    return "note";
}

Diagnostic& Diagnostic::with_hint(std::string text) {
    hint = std::move(text);
    return *this;
}

Diagnostic& Diagnostic::with_note(Span where, std::string text) {
    notes.push_back({where, std::move(text)});
    return *this;
}

Diagnostic& Diagnostics::error(Span span, std::string message) {
    ++error_count_;
    return add(Severity::error, span, std::move(message));
}

Diagnostic& Diagnostics::warning(Span span, std::string message) {
    ++warning_count_;
    return add(Severity::warning, span, std::move(message));
}

Diagnostic& Diagnostics::note(Span span, std::string message) {
    return add(Severity::note, span, std::move(message));
}

void Diagnostics::add(const Diagnostics& others) {
    for (const Diagnostic& other : others.all_) {
        error_count_ += other.severity == Severity::error ? 1 : 0;
        warning_count_ += other.severity == Severity::warning ? 1 : 0;
        add(other.severity, other.span, other.message) = other;
    }
    if (others.error_count_ > max_errors)
        error_count_ += others.error_count_ - max_errors; // counted, not kept
}

void Diagnostics::drop_repeated_remarks(std::size_t since) {
    const auto repeated = [&](const Diagnostic& finding) {
        if (finding.severity == Severity::error) return false;
        return std::any_of(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(since),
                           [&](const Diagnostic& known) {
                               return known.span == finding.span && known.message == finding.message;
                           });
    };
    if (since >= all_.size()) return;
    all_.erase(std::remove_if(all_.begin() + static_cast<std::ptrdiff_t>(since), all_.end(), repeated),
               all_.end());
}

Diagnostic& Diagnostics::add(Severity severity, Span span, std::string message) {
    const std::size_t count = severity == Severity::error ? error_count_ : warning_count_;
    Diagnostic diagnostic{severity, span, std::move(message), {}, {}};
    if (count > max_errors) return overflow_ = std::move(diagnostic);
    all_.push_back(std::move(diagnostic));
    return all_.back();
}

std::string Diagnostics::render(const SourceMap& sources, bool quiet) const {
    std::string out;
    for (const Diagnostic& diagnostic : all_) {
        if (quiet && diagnostic.severity == Severity::note) continue;
        const char* severity = name_of(diagnostic.severity);
        out += fmt::format("{}: {}: {}\n", place(sources, diagnostic.span), severity,
                           escaped(diagnostic.message, longest_message));
        append_excerpt(out, sources, diagnostic.span);
        if (!diagnostic.hint.empty())
            out += fmt::format("    hint: {}\n", escaped(diagnostic.hint, longest_message));
        for (const Note& note : diagnostic.notes) {
            out += fmt::format("{}: note: {}\n", place(sources, note.span),
                               escaped(note.message, longest_message));
            append_excerpt(out, sources, note.span);
        }
        if (const Span origin = sources.origin(diagnostic.span); origin.known()) {
            out += fmt::format("{}: note: translated from here\n", place(sources, origin));
            append_excerpt(out, sources, origin);
        }
    }
    if (error_count_ > max_errors) out += fmt::format("graftal: {} more errors\n", error_count_ - max_errors);
    return out;
}

namespace {

/// Optimal string alignment distance (Damerau-Levenshtein without overlapping edits), small letters and
/// capitals alike.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const auto same = [&](std::size_t i, std::size_t j) { return small_letter(a[i]) == small_letter(b[j]); };
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j)
        d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = d[i - 1][j - 1] + (same(i - 1, j - 1) ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, change});
            if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1))
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

/// `prob` for `probability`, `lsystem` for `lsys`.
bool begins_alike(std::string_view a, std::string_view b) {
    constexpr std::size_t least = 3;
    const std::size_t size = std::min(a.size(), b.size());
    return size >= least && edit_distance(a.substr(0, size), b.substr(0, size)) == 0;
}

} // namespace

std::string closest_name(std::string_view name, const std::vector<std::string>& candidates) {
    constexpr std::size_t longest_name = 64;
    if (name.size() > longest_name) return {};
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > longest_name || candidate == name) continue;
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < best_distance && distance < name.size()) {
            best_distance = distance;
            best = candidate;
        }
    }
    if (!best.empty()) return best;
    const auto alike = std::find_if(candidates.begin(), candidates.end(), [&](const std::string& candidate) {
        return candidate != name && begins_alike(name, candidate);
    });
    return alike == candidates.end() ? "" : *alike;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
    const std::string best = closest_name(name, candidates);
    return best.empty() ? "" : fmt::format("did you mean '{}'?", best);
}

std::string choices(std::string_view name, const std::vector<std::string>& candidates) {
    std::string hint = did_you_mean(name, candidates);
    std::string list;
    for (auto it = candidates.begin(); it != candidates.end(); ++it) {
        const std::string& candidate = *it;
        if (candidate.empty() || std::find(candidates.begin(), it, candidate) != it) continue;
        list += (list.empty() ? "" : ", ") + candidate;
        if (list.size() > longest_list) break;
    }
    if (list.empty() || list.size() > longest_list) return hint;
    return hint + (hint.empty() ? "known here: " : " known here: ") + list;
}

} // namespace graftal
