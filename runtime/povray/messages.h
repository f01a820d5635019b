#pragma once

// POV-Ray 3.7's text on standard error, taken apart: progress counters that end in a carriage return,
// messages wrapped at 80 columns, times, and the words that tell success from failure.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graftal {

struct PovrayMessage {
    /// The more serious, the later.
    enum class Kind {
        warning,
        possible_error, ///< POV-Ray's own term; an error only if the run fails
        error,
    };
    Kind kind = Kind::error;
    std::string file; ///< empty where POV-Ray names none
    int line = 0;     ///< from 1; 0 where POV-Ray names none
    std::string text; ///< unwrapped, without "Parse Error: "

    bool operator==(const PovrayMessage&) const = default;
};

struct PovrayProgress {
    enum class Stage { parsing, bounding, rendering };
    Stage stage = Stage::parsing;
    std::optional<double> fraction; ///< of the stage, in [0, 1], where it is known

    bool operator==(const PovrayProgress&) const = default;
};

/// All that the driver needs to know of one run.
struct PovrayLog {
    /// More are dropped: a scene of a million placements can give a million warnings. An error, which comes
    /// last, takes the place of a warning.
    static constexpr std::size_t max_messages = 100;

    std::vector<PovrayMessage> messages;
    std::vector<std::string> last_lines; ///< of the output, for failures without a message
    bool finished = false;               ///< "POV-Ray finished" was printed
    bool illegal_matrix = false;         ///< a degenerate matrix was replaced: the picture is wrong
    bool no_objects = false;
    std::optional<double> parse_seconds, bounding_seconds, trace_seconds;
    std::optional<std::uint64_t> finite_objects;
};

/// Reads standard error piece by piece, cut anywhere.
class PovrayMessageReader {
  public:
    explicit PovrayMessageReader(std::function<void(const PovrayProgress&)> on_progress = {});

    void feed(std::string_view text);
    /// Call at the end of the text; then log() is complete.
    void finish();
    /// Reports that all is rendered, if that was not said.
    void complete() { report({PovrayProgress::Stage::rendering, 1.0}); }
    const PovrayLog& log() const { return log_; }

  private:
    void read_line(std::string_view line);
    bool continues_message(std::string_view line) const;
    void close_message();
    bool read_progress(std::string_view line);
    void read_message(std::string_view line);
    void keep(PovrayMessage message);
    void read_statistics(std::string_view line);
    void report(PovrayProgress progress);

    std::function<void(const PovrayProgress&)> on_progress_;
    PovrayLog log_;
    std::string partial_;                ///< the line that has no end yet
    std::optional<std::string> pending_; ///< a message that the next line may continue
    std::size_t last_length_ = 0;        ///< of the line that pending_ ends with
    std::optional<PovrayProgress> reported_;
};

} // namespace graftal
