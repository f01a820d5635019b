#pragma once

#include <string>
#include <vector>

#include "compiler/support/source.h"

namespace graftal {

enum class Severity { error, warning, note };
/// The word that messages begin with: "error", "warning" or "note".
const char* name_of(Severity severity);

/// A second place that a diagnostic points at, e.g. "first defined here".
struct Note {
    Span span;
    std::string message;
};

/// One finding about a model. Messages start in lower case and end without a full stop.
struct Diagnostic {
    Severity severity = Severity::error;
    Span span;
    std::string message;
    std::string hint; ///< text to write instead; may be empty
    std::vector<Note> notes;

    Diagnostic& with_hint(std::string text);
    Diagnostic& with_note(Span where, std::string text);
};

/// Collects what is wrong with the input, so that one run reports all of it. Bad input only: broken
/// invariants abort (check.h), and environment failures are returned as Status (status.h).
class Diagnostics {
  public:
    /// After this many errors the rest is counted, not stored: hostile input cannot fill the memory.
    static constexpr std::size_t max_errors = 100;

    /// The returned reference is valid until the next call.
    Diagnostic& error(Span span, std::string message);
    Diagnostic& warning(Span span, std::string message);
    /// Nothing is wrong, but the picture can be better.
    Diagnostic& note(Span span, std::string message);

    /// Adds the findings of another collection, in their order.
    void add(const Diagnostics& others);

    /// Takes back the warnings and notes behind the first `since` findings that say what one before says at
    /// the same place.
    void drop_repeated_remarks(std::size_t since);

    bool has_errors() const { return error_count_ > 0; }
    std::size_t error_count() const { return error_count_; }
    /// True when max_errors is reached; parsers stop then.
    bool full() const { return error_count_ >= max_errors; }
    const std::vector<Diagnostic>& all() const { return all_; }

    /// The GNU form `file:line:column: error: message`, with the line, a caret, the hint and the notes.
    /// `quiet` leaves notes out.
    std::string render(const SourceMap& sources, bool quiet = false) const;

  private:
    Diagnostic& add(Severity severity, Span span, std::string message);

    std::vector<Diagnostic> all_;
    Diagnostic overflow_;
    std::size_t error_count_ = 0;
    std::size_t warning_count_ = 0;
};

/// The candidate closest to a misspelt name, or "" if none is close enough to be what was meant: at most a
/// third of its letters wrong, where transpositions count once and capitals not at all; else one that begins
/// with the name, or that the name begins with.
std::string closest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The hint "did you mean 'x'?" for closest_name, or "" if there is none.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

/// The hint of did_you_mean(), followed by all candidates where they are few.
std::string choices(std::string_view name, const std::vector<std::string>& candidates);

} // namespace graftal
