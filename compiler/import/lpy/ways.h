#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/lpy/python.h"

namespace graftal {

/// Follows the statements of a rule, or of a function, through their conditions.
class LpyWays {
  public:
    enum class Of { rule, function };

    /// `python` must outlive this.
    LpyWays(LpyPython& python, Of of) : python_(python), of_(of) {}

    /// The ways that produce something, in the order of the text.
    std::vector<LpyPath> all(const std::vector<LpyLine>& lines, const LpyValues& values);

    /// Result of a function, as one expression; nothing where that has no translation.
    std::optional<std::string> result(const std::vector<LpyLine>& lines, const LpyValues& values);

  private:
    /// Lines that are still to follow: those from `at` on, and then those behind them.
    struct Rest {
        const std::vector<LpyLine>* lines;
        std::size_t at;
        const Rest* next;
    };
    /// The bounds of a number that chance drew from 0 to 1, and of which conditions ask.
    struct Draw {
        std::string low = "0", high = "1";
    };
    struct State {
        LpyPath path;
        std::map<std::string, Draw, std::less<>> draws; ///< by their names
        std::set<std::string, std::less<>> once;        ///< values of chance that were not used yet
    };

    void follow(const Rest* rest, State state);
    void decide(const Rest& rest, State state);
    bool assign(const LpyLine& line, State& state);
    std::string value(std::string_view text, Span span, State& state);
    void ask(std::string_view condition, Span span, State& holds, State& fails);
    bool ask_chance(std::string_view condition, Span span, State& holds, State& fails);
    void end(State state);
    void fail(Span span, const std::string& message);

    LpyPython& python_;
    Of of_;
    std::vector<LpyPath> ways_;
    int depth_ = 0, steps_ = 0, draws_ = 0;
    bool good_ = true;
};

} // namespace graftal
