#include "compiler/inst/parse/body.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/inst/parse/references.h"
#include "compiler/inst/parse/repeat.h"
#include "compiler/syntax/everyday_words.h"
#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

/// The blocks around the next group, the outermost first.
template<typename T> class Blocks {
  public:
    void push(T block) {
        blocks_.push_back(std::move(block));
        shared_.reset();
    }
    void pop() {
        blocks_.pop_back();
        shared_.reset();
    }
    std::size_t size() const { return blocks_.size(); }
    bool empty() const { return blocks_.empty(); }

    /// The list is shared by all groups until the next change.
    const InstSharedList<T>& shared() {
        if (!shared_) shared_.emplace(blocks_);
        return *shared_;
    }

  private:
    std::vector<T> blocks_;
    std::optional<InstSharedList<T>> shared_;
};

/// The lines of one object, from its '{' to its '}'.
class BodyParser {
  public:
    BodyParser(TokenStream& stream, InstDefinition& definition, std::size_t& scatters)
        : stream_(stream), diagnostics_(stream.diagnostics()), definition_(definition), scatters_(scatters) {}

    /// Requires that the '{' was just taken. False if the object's '}' is missing.
    bool parse() {
        if (Diagnostic* const missing =
                parse_lines(fmt::format("'}}' at the end of object '{}'", definition_.name))) {
            if (stream_.at("material"))
                missing->with_hint("define materials outside of objects; inside, write the material's name: "
                                   "'material: NAME'");
            return false;
        }
        measure_group();
        check_not_empty();
        return true;
    }

  private:
    /// The next token begins a statement of the file: the '}' of this object is missing.
    bool begins_statement() const {
        const Token& word = stream_.peek();
        const Token& after = stream_.peek(1);
        const Token& third = stream_.peek(2);
        const bool name_next = after.kind == TokenKind::name;
        if (word.is("canonical") || word.is("object")) return name_next;
        if (word.is("let") || word.is("inner") || word.is("use")) return name_next && third.is("=");
        if (word.is("material")) return name_next && third.is("{");
        if (word.is("camera") || word.is("light") || word.is("ground")) return after.is("{");
        if (word.is("background")) return after.is("{") || after.is(":");
        return word.is("steps") && (after.is(":") || after.kind == TokenKind::number);
    }

    /// The lines of a block whose '{' was just taken, and its '}'. Gives the error if that is missing.
    Diagnostic* parse_lines(std::string_view wanted_end) {
        const Token open = stream_.previous();
        while (!diagnostics_.full() && !stream_.accept("}")) {
            if (stream_.at_end() || begins_statement())
                return &stream_.expected(wanted_end).with_note(open.span, "to close this '{'");
            if (!stream_.accept(",") && !parse_line()) {
                failed_ = true;
                stream_.skip_line();
            }
        }
        return nullptr;
    }

    bool parse_line() {
        if (at_transform(stream_)) return parse_transform_line();
        if (stream_.at("tint")) return parse_tint_line();
        if (stream_.at("material")) return parse_material();
        if (at_chance()) return parse_chance();
        if (at_below()) return parse_below();
        if (at_repeat(stream_)) return parse_repeat();
        if (at_hue(stream_)) return parse_hue();
        if (at_ink(stream_)) return parse_ink();
        if (at_when()) return parse_when();
        if (at_nothing()) return parse_nothing();
        if (at_group()) return parse_group();
        if (in_scatter() && at_scatter_line(stream_)) return parse_line_of_scatter();
        if (stream_.at_name()) return parse_bare_group();
        const bool open = stream_.at("{"), number = stream_.peek().kind == TokenKind::number;
        const Token& before = stream_.previous();
        Diagnostic& error = stream_.expected("a line of an object");
        error.with_hint(number                                   ? "is it one number too many?"
                        : open && before.kind == TokenKind::name ? braced_word_hint(before.text, "...")
                                                                 : choices("", body_lines()));
        stream_.next();
        if (open) stream_.skip_block();
        return false;
    }

    /// The keywords of lines that any object may have.
    static std::vector<std::string> body_lines() {
        const std::vector<std::string>& all = body_keywords();
        std::vector<std::string> lines(all.begin(),
                                       all.end() - static_cast<std::ptrdiff_t>(scatter_keywords().size()));
        for (const char* word : {"repeat", "when", "nothing"})
            lines.emplace_back(word);
        return lines;
    }

    /// `scatter: tree`, `difference cube`, and not an object of that name.
    bool at_scatter_or_combination() const {
        const Token& after = stream_.peek(1);
        return (stream_.at("scatter") || stream_.at("intersection") || stream_.at("difference")) &&
               (after.is(":") || (after.kind == TokenKind::name && !after.first_on_line));
    }

    bool in_scatter() const {
        return !lost_group_ && !definition_.groups.empty() && definition_.groups.back().scatter;
    }

    bool parse_line_of_scatter() {
        InstScatter& scatter = *definition_.groups.back().scatter;
        const bool good = parse_scatter_line(stream_, scatter);
        scatter.complete = scatter.complete && good;
        return good;
    }

    // Repeats

    /// The count, the block of lines that each copy adds, and the repeated groups: one, or those of a block.
    bool parse_repeat() {
        std::optional<InstRepeat> repeat = parse_inst_repeat(stream_);
        sealed_ |= !repeat; // lines behind it are not of the group before
        if (!repeat) return false;
        if (repeats_.size() == TokenStream::max_nesting) {
            diagnostics_
                .error(repeat->span, fmt::format("repeats nest more than {} deep", TokenStream::max_nesting))
                .with_hint("define an object that contains the inner repeats, and repeat that object");
            return false;
        }
        repeats_.push(std::make_shared<const InstRepeat>(std::move(*repeat)));
        const bool good = parse_repeated();
        repeats_.pop();
        return good;
    }

    bool parse_repeated() {
        if (!stream_.accept("{")) {
            const std::size_t groups = definition_.groups.size();
            if (at_repeat(stream_)) return parse_repeat();
            const bool name = stream_.at_name() && (!is_body_keyword(stream_.peek()) || at_group());
            if (name && !at_hue(stream_) && !at_chance() &&
                (at_group() ? parse_group() : parse_plain_group()))
                return true;
            if (groups == definition_.groups.size() && !name)
                stream_.expected("the objects to repeat")
                    .with_hint("write them after the braces: repeat 12 { rotate: y, 30 } leaf");
            return false;
        }
        sealed_ = true;
        if (parse_lines("'}' at the end of the repeated objects")) return false;
        sealed_ = true;
        return true;
    }

    bool at_group() const {
        return stream_.at("union") || stream_.at("instance") || stream_.at("terminal") ||
               at_scatter_or_combination();
    }

    bool parse_hue() {
        const Token keyword = stream_.peek();
        std::optional<Expression> hue;
        if (!parse_hue_value(stream_, hue)) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (group->hue) report_duplicate(keyword, *group->hue);
        group->hue = std::make_unique<Expression>(std::move(*hue));
        return true;
    }

    bool parse_ink() {
        const Token keyword = stream_.peek();
        std::vector<InstInkStep> steps;
        if (!parse_inst_ink(stream_, steps)) return false;
        if (InstGroup* group = current(keyword)) std::ranges::move(steps, std::back_inserter(group->ink));
        return true;
    }

    // Conditions

    /// `when` and an expression; else an object may have that name.
    bool at_when() const {
        const Token& after = stream_.peek(1);
        const bool value = after.kind == TokenKind::number || after.is("(") || after.is("-") ||
                           after.is("!") || (after.kind == TokenKind::name && !is_body_keyword(after));
        return stream_.at("when") && !after.first_on_line && value;
    }

    bool parse_when() {
        const Token keyword = stream_.next();
        std::optional<Expression> test = parse_expression(stream_);
        if (!test || !stream_.expect("{", "the condition")) return false;
        if (conditions_.size() == TokenStream::max_nesting) {
            diagnostics_.error(keyword.span,
                               fmt::format("conditions nest more than {} deep", TokenStream::max_nesting));
            return false;
        }
        const auto shared =
            std::make_shared<const InstTest>(InstTest{std::move(*test), stream_.span_from(keyword.span)});
        definition_.tests.push_back(shared);
        if (!parse_conditional({shared, true})) return false;
        if (!stream_.accept("else")) return true;
        if (stream_.at("when")) { // `else when`: the rest is inside of this one
            conditions_.push({shared, false});
            const bool good = at_when() && parse_when();
            conditions_.pop();
            return good;
        }
        return stream_.expect("{", "else") && parse_conditional({shared, false});
    }

    /// Requires that the '{' was just taken.
    bool parse_conditional(InstCondition condition) {
        conditional_ = true;
        conditions_.push(std::move(condition));
        sealed_ = true;
        const bool good = !parse_lines("'}' at the end of the groups under a condition");
        sealed_ = true;
        conditions_.pop();
        return good;
    }

    /// `nothing` on a line of its own.
    bool at_nothing() const {
        const Token& after = stream_.peek(1);
        return stream_.at("nothing") && (after.first_on_line || after.is("}"));
    }

    bool parse_nothing() {
        stream_.next();
        conditional_ = true;
        sealed_ = true;
        return true;
    }

    bool parse_group() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        InstGroup group;
        group.terminal = keyword.is("terminal");
        if (keyword.is("scatter")) {
            group.scatter = std::make_unique<InstScatter>();
            group.scatter->ordinal = scatters_++;
        }
        lost_group_ = !parse_inst_references(stream_, group.masters, keyword.text);
        if (lost_group_) return false;
        group.span = stream_.span_from(keyword.span);
        take_combination(keyword);
        return group.terminal ? add_terminal(std::move(group)) : add(std::move(group));
    }

    /// One word says how all groups of an object combine; `instance` and bare names leave it open.
    void take_combination(const Token& keyword) {
        std::optional<Combination> named;
        if (keyword.is("union")) named = Combination::unite;
        if (keyword.is("intersection")) named = Combination::intersect;
        if (keyword.is("difference")) named = Combination::subtract;
        if (!named) return;
        if (!definition_.combination) {
            definition_.combination = named;
            definition_.combination_span = keyword.span;
        } else if (*definition_.combination != *named) {
            diagnostics_
                .error(keyword.span,
                       fmt::format("object '{}' combines its parts in two ways", definition_.name))
                .with_note(definition_.combination_span, "the first is here")
                .with_hint(fmt::format("define an object for the {} of its own, and name that object here",
                                       keyword.text));
        }
    }

    /// `triangle` alone. Other names are more likely a slip: a misspelt keyword or a missing comma.
    bool parse_bare_group() {
        const Token name = stream_.peek();
        const bool begins_line = name.first_on_line || stream_.previous().is("{");
        if (stream_.peek(1).is(":")) {
            const bool scattered = at_scatter_line(stream_);
            stream_.next();
            if (scattered && lost_group_) return false; // its scatter is in error
            if (scattered) {
                diagnostics_.error(name.span, fmt::format("'{}' belongs to a scatter", name.text))
                    .with_hint(line_word_hint(name.text) +
                               (line_word_hint(name.text).empty() ? "" : "; or ") +
                               "open the group with 'scatter:'");
                return false;
            }
            diagnostics_.error(name.span, fmt::format("unknown keyword '{}'", name.text))
                .with_hint(keyword_hint(name));
            return false;
        }
        if (!begins_line) {
            std::string hint = lost_product_hint(stream_.previous(), name);
            stream_.next();
            const bool value = stream_.peek().kind == TokenKind::number || stream_.at("<");
            if (hint.empty()) hint = value ? keyword_hint(name) : did_you_mean(name.text, body_keywords());
            diagnostics_
                .error(name.span, value ? fmt::format("unknown keyword '{}'", name.text)
                                        : fmt::format("expected ',' or a new line before '{}'", name.text))
                .with_hint(hint);
            return false;
        }
        return parse_plain_group();
    }

    bool parse_plain_group() {
        const Token name = stream_.peek();
        InstGroup group;
        if (!parse_inst_references(stream_, group.masters, {})) return false;
        group.span = stream_.span_from(name.span);
        return add(std::move(group));
    }

    static std::string keyword_hint(const Token& word) {
        if (std::string hint = line_word_hint(word.text); !hint.empty()) return hint;
        const std::string meant = did_you_mean(word.text, body_keywords());
        return meant.empty() ? choices(word.text, body_lines()) : meant;
    }

    /// Ends the last group and measures its lines. Its masters come before these lines, and count by the
    /// length of their text.
    void measure_group() {
        if (definition_.groups.empty()) return;
        InstGroup& group = definition_.groups.back();
        std::size_t size = stream_.position() - group_begin_ + group.masters.size();
        for (const InstReference& master : group.masters)
            size += master.span.end - master.span.begin;
        group.size = static_cast<std::uint32_t>(size);
    }

    bool add(InstGroup group) {
        lost_group_ = sealed_ = false;
        if (!repeats_.empty() && (group.terminal || group.scatter)) {
            diagnostics_
                .error(group.span,
                       fmt::format("a repeat cannot contain a {}", group.terminal ? "terminal" : "scatter"))
                .with_hint("define an object that has it, and repeat that object");
        }
        group.conditions = conditions_.shared();
        group.repeats = repeats_.shared();
        measure_group();
        group_begin_ = stream_.position();
        definition_.groups.push_back(std::move(group));
        return true;
    }

    bool add_terminal(InstGroup group) {
        const auto other = std::ranges::find(definition_.groups, true, &InstGroup::terminal);
        if (other != definition_.groups.end())
            diagnostics_
                .error(group.span, fmt::format("object '{}' already has a terminal", definition_.name))
                .with_note(other->span, "first given here");
        if (group.masters.size() > 1)
            diagnostics_.error(group.masters[1].span, "'terminal' names one object only");
        return add(std::move(group));
    }

    /// The group that a line belongs to, or nothing after an error. After a group in error its lines are
    /// silent.
    InstGroup* current(const Token& keyword) {
        if (!definition_.groups.empty() && !sealed_) return &definition_.groups.back();
        if (!failed_)
            diagnostics_.error(keyword.span, fmt::format("'{}' has no object to apply to", keyword.text))
                .with_hint("name the objects first, with 'union:' or 'instance:'");
        failed_ = true;
        return nullptr;
    }

    void report_duplicate(const Token& keyword, const Expression& first) {
        diagnostics_.error(keyword.span, fmt::format("duplicate '{}'", keyword.text))
            .with_note(first.span, "first given here");
    }

    bool parse_transform_line() {
        const Token keyword = stream_.peek();
        std::optional<TransformLine> line = parse_transform(stream_);
        if (!line) return false;
        if (InstGroup* group = current(keyword)) group->transforms.push_back(std::move(*line));
        return true;
    }

    bool parse_tint_line() {
        const Token keyword = stream_.peek();
        std::optional<InstTint> tint = parse_inst_tint(stream_);
        if (!tint) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (!tint->until.empty() && !group->scatter) refuse_tint_range(tint->span, diagnostics_);
        group->tints.push_back(std::move(*tint));
        return true;
    }

    bool parse_material() {
        const Token keyword = stream_.next();
        stream_.accept(":");
        const std::optional<Token> name = stream_.expect_name("a name after 'material'");
        if (!name) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (group->material)
            diagnostics_.error(name->span, "these objects already have a material")
                .with_note(group->material_span, "first given here");
        group->material = name->text;
        group->material_span = name->span;
        return true;
    }

    /// `chance: 0.8` or `chance 0.8`; else an object may have that name.
    bool at_chance() const {
        const Token& after = stream_.peek(1);
        return stream_.at("chance") && (after.is(":") || after.kind == TokenKind::number);
    }

    bool parse_chance() {
        return parse_number(&InstGroup::chance, false, "a terminal has no chance",
                            "a terminal stands for the whole object wherever graftal cuts it");
    }

    /// `below: 12`, or after a terminal `below 12`; else an object may have that name.
    bool at_below() const {
        const bool after_terminal = !definition_.groups.empty() && definition_.groups.back().terminal;
        return stream_.at("below") && (after_terminal || stream_.peek(1).is(":"));
    }

    bool parse_below() {
        return parse_number(&InstGroup::below, true, "'below' belongs to a terminal",
                            "it sets the size in pixels below which the terminal replaces the object");
    }

    /// A line that terminals have, or all but terminals; the problem and hint are for the others.
    bool parse_number(std::optional<Expression> InstGroup::*number, bool of_terminals, const char* problem,
                      const char* hint) {
        const Token keyword = stream_.next();
        stream_.accept(":");
        std::optional<Expression> value = parse_expression(stream_);
        if (!value) return false;
        InstGroup* group = current(keyword);
        if (!group) return true;
        if (group->terminal != of_terminals)
            diagnostics_.error(keyword.span, problem).with_hint(hint);
        else if (group->*number)
            report_duplicate(keyword, *(group->*number));
        group->*number = std::move(value);
        return true;
    }

    void check_not_empty() {
        if (std::ranges::count(definition_.groups, false, &InstGroup::terminal) > 0 || conditional_ ||
            failed_ || diagnostics_.full())
            return;
        diagnostics_.error(definition_.span, fmt::format("object '{}' is empty", definition_.name))
            .with_hint("give it a 'union:' or an 'instance:', or write 'nothing' if that is meant");
    }

    TokenStream& stream_;
    Diagnostics& diagnostics_;
    InstDefinition& definition_;
    std::size_t& scatters_;
    bool failed_ = false;
    std::size_t group_begin_ = 0; ///< of the lines of the last group
    bool sealed_ = false;         ///< after the '{' or '}' of a block of repeated groups, a line has no group
    Blocks<std::shared_ptr<const InstRepeat>> repeats_; ///< around the next group
    Blocks<InstCondition> conditions_;                  ///< of the next group
    bool conditional_ = false;                          ///< the object may draw nothing
    bool lost_group_ = false;                           ///< the last group was in error
};

} // namespace

bool parse_inst_body(TokenStream& stream, InstDefinition& definition, std::size_t& scatters) {
    return BodyParser(stream, definition, scatters).parse();
}

} // namespace graftal
