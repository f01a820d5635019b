#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/support/control.h"
#include "runtime/inverse/lsystem/growth.h"
#include "runtime/inverse/lsystem/stroke_graph.h"

namespace graftal {

/// A symbol of a rule: a letter by its number, a turn to the left by angles, or a bracket.
struct RuleSymbol {
    enum class Kind : std::uint8_t { letter, turn, open, close };
    Kind kind = Kind::letter;
    std::int32_t value = 0;
    bool operator==(const RuleSymbol&) const = default;
};

using RuleWord = std::vector<RuleSymbol>;

/// A system that draws all strokes of a graph, each as often as it lies there.
struct FoundGrammar {
    LsysGrowth growth;
    RuleWord axiom;
    std::vector<RuleWord> rules; ///< of the letters
    std::uint32_t start = 0;     ///< place
    std::int32_t direction = 0;  ///< that the turtle has there
};

/// Looks for the rules of a growth by unfolding a system before its rules are known: a turtle follows the
/// word from left to right, and what the word says next is guessed where no rule says it yet. A guess is
/// given up where the turtle leaves the drawing, or takes a stroke too often.
///
/// Letters that draw nothing are guessed only where what they become is drawn, and turns only where the
/// turtle draws after them; so most guesses are tried on strokes at once.
class Unfolding {
  public:
    /// Both must outlive this. The meter counts modules.
    Unfolding(const StrokeGraph& graph, WorkMeter& meter);

    /// The first system with this growth that begins at this place in this direction, if one is found in so
    /// many modules. Each `order` from 1 on tries guesses in an order of its own: one may be lucky where
    /// another is not (Gomes, Selman and Kautz 1998, "Boosting combinatorial search through randomization").
    /// `known`: rules of which only the turns are looked for.
    std::optional<FoundGrammar> find(const LsysGrowth& growth, std::uint32_t start, std::int32_t direction,
                                     std::uint64_t most_modules, unsigned order = 0,
                                     const BareRules* known = nullptr);
    /// Whether the last search ended by its limit.
    bool gave_up() const { return gave_up_; }
    /// Modules that the last search took.
    std::uint64_t modules() const { return modules_; }

  private:
    using Number = std::int32_t; ///< of an unknown turn
    static constexpr Number no_turn = 0, first_turn = 1;

    /// A direction as a sum with unknown turns.
    struct Heading {
        struct Term {
            Number turn = 0;
            std::int32_t factor = 0;
        };
        std::int32_t known = 0;
        std::uint8_t count = 0;
        bool lost = false; ///< too many unknowns
        std::array<Term, 14> terms = {};
    };

    enum class Mark : std::uint8_t { letter, open, close };
    static constexpr std::int16_t any_letter = -1;

    /// A letter that draws nothing, or a bracket around such letters.
    struct Item {
        Mark mark = Mark::letter;
        std::int16_t letter = 0;
        Number turn = no_turn; ///< before it
    };
    /// The items between two tokens.
    struct Gap {
        std::vector<Item> items;
        bool closed = false; ///< no more will come
        std::uint8_t open = 0;
    };
    /// A letter that draws, or a bracket around such letters.
    struct Token {
        Mark mark = Mark::letter;
        std::int16_t letter = any_letter;
        Number turn = no_turn; ///< from the token before, as long as items draw nothing
    };
    struct Rule {
        std::vector<Token> tokens;
        std::vector<Gap> gaps; ///< before each token, and at the end
        bool complete = false;
        Number end_turn = no_turn;
        std::uint8_t open = 0, brackets = 0, drawn = 0, hidden = 0;
        LsysGrowth::Counts counts{}; ///< by letter, as far as letters are known
    };

    struct Frame {
        std::int16_t rule = 0, level = 0;
        std::uint16_t token = 0, item = 0;
    };
    struct Branch {
        std::uint32_t place = 0;
        Heading heading;
    };
    struct State {
        std::vector<Frame> frames;
        std::vector<Branch> branches;
        Heading heading;
        std::uint32_t place = 0;
        std::uint32_t run = 0;   ///< strokes to draw straight ahead
        std::uint8_t length = 0; ///< their class
    };

    void lay_down(std::size_t number, const BareWord& word);
    bool unfold(State state);
    bool is_reversed(const Frame& frame) const;
    bool follow(State& state);
    bool guess_item(const State& state);
    bool guess_token(const State& state);
    bool guess_letter(const State& state);
    bool guess_turn(const State& state);
    bool draw(State& state, bool& ended);
    bool meet_item(State& state, const Item& item);
    bool meet_token(State& state);
    bool finish_rule(State& state);
    bool try_item(const State& state, const Item& item);
    bool try_token(const State& state, const Token& token);
    bool guess_multiple(const State& state, const std::vector<std::int32_t>& open);
    bool try_turn(const State& state, Number turn, const Heading& value);
    bool take(State& state, const StrokeWay& way);
    bool strands(const State& state, std::uint32_t place) const;
    bool close_branch(State& state) const;
    bool try_way(const State& state, const StrokeWay& way);

    void turn_by(Heading& heading, Number turn, std::int32_t factor) const;
    void settle(Heading& heading) const;
    void turn_after_gap(State& state, const Frame& frame, const Rule& rule, Number turn) const;
    Number new_turn();
    std::int32_t reduced(std::int32_t direction) const;
    std::vector<std::int32_t> turns_in_order() const;
    bool fixes_turn(std::size_t rule) const;
    bool is_hidden(std::size_t letter) const { return letter >= growth_.drawn; }
    bool is_axiom(std::int16_t rule) const { return static_cast<std::size_t>(rule) == growth_.letters; }
    bool has_hidden() const { return growth_.letters > growth_.drawn; }
    bool may_count(std::size_t rule, std::size_t letter) const;
    bool is_next(std::size_t letter) const;
    bool may_fit();
    void restore(std::size_t taken);
    RuleWord word_of(const Rule& rule) const;
    void add_turn(RuleWord& word, std::int32_t turn) const;
    std::int32_t value(Number turn) const;

    const StrokeGraph& graph_;
    WorkMeter& meter_;
    LsysGrowth growth_;
    std::vector<Rule> rules_; ///< of the letters, and the axiom
    struct Turn {
        bool known = false;
        Heading value;
    };
    std::vector<Turn> turns_;                     ///< by number
    std::vector<std::uint32_t> left_;             ///< copies of each bundle that are not drawn yet
    std::vector<std::uint32_t> leaving_, coming_; ///< of each place: strokes that are not drawn yet
    struct Taken {
        std::uint32_t bundle = 0, from = 0, to = 0;
    };
    std::vector<Taken> taken_;   ///< in the order of drawing
    std::int32_t direction_ = 0; ///< of the first stroke
    unsigned order_ = 0;
    std::uint64_t modules_ = 0, most_modules_ = 0;
    unsigned depth_ = 0;
    bool gave_up_ = false;
};

} // namespace graftal
