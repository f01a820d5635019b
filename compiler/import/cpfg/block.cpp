#include "compiler/import/cpfg/block.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "compiler/import/cpfg/expression.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr int most_nested_blocks = 64;

class BlockReader {
  public:
    /// `expands`: macros may stand for statements.
    BlockReader(std::string_view text, Span span, CpfgNames& names, bool expands = true)
        : text_(text), span_(span), names_(names), expands_(expands) {}

    std::optional<LSystemBlock> read() {
        LSystemBlock block;
        while (good_ && !at_end())
            read_statement(block, 0);
        if (!good_) return std::nullopt;
        return block;
    }

  private:
    bool at_end() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == ';'))
            ++at_;
        return at_ >= text_.size();
    }

    std::string_view word() const { return cpfg_name_at(text_, at_); }

    bool accept(std::string_view wanted) {
        if (at_end() || word() != wanted) return false;
        at_ += wanted.size();
        return true;
    }

    void fail(const std::string& message) {
        if (good_) names_.error(span_, message);
        good_ = false;
    }

    void read_statement(LSystemBlock& block, int depth) {
        if (depth > most_nested_blocks) return fail("blocks are nested too deeply");
        if (at_end()) return;
        if (text_[at_] == '{') return read_braces(block, depth);
        if (accept("if")) {
            LSystemAction& action = block.emplace_back();
            action.kind = LSystemAction::Kind::branch;
            action.value = parenthesis();
            LSystemBlock then, otherwise;
            read_statement(then, depth + 1);
            const bool has_otherwise = accept("else");
            if (has_otherwise) read_statement(otherwise, depth + 1);
            action.then = std::move(then);
            action.otherwise = std::move(otherwise);
            action.has_otherwise = has_otherwise;
        } else if (accept("while")) {
            LSystemAction action;
            action.kind = LSystemAction::Kind::loop;
            action.value = parenthesis();
            read_statement(action.then, depth + 1);
            block.push_back(std::move(action));
        } else if (accept("do")) {
            LSystemAction action;
            action.kind = LSystemAction::Kind::loop_after;
            read_statement(action.then, depth + 1);
            if (!accept("while")) return fail("'do' without 'while'");
            action.value = parenthesis();
            block.push_back(std::move(action));
        } else {
            read_simple(block);
        }
    }

    void read_braces(LSystemBlock& block, int depth) {
        ++at_;
        while (good_ && !at_end() && text_[at_] != '}')
            read_statement(block, depth + 1);
        if (at_ < text_.size()) ++at_;
    }

    /// The text in the parentheses that come next, as an expression.
    std::string parenthesis() {
        if (at_end() || text_[at_] != '(') {
            fail("expected '(' behind 'if' or 'while'");
            return "0";
        }
        const std::size_t begin = at_ + 1;
        at_ = std::min(end_of_parentheses(text_, at_), text_.size());
        return names_.expression(text_.substr(begin, at_ - begin - 1), span_);
    }

    /// The text up to a semicolon, past strings.
    std::string_view simple_text() {
        const std::size_t begin = at_;
        bool quoted = false;
        for (; at_ < text_.size(); ++at_) {
            if (text_[at_] == '\\' && quoted)
                ++at_;
            else if (text_[at_] == '"')
                quoted = !quoted;
            else if (!quoted && (text_[at_] == ';' || text_[at_] == '}'))
                break;
        }
        at_ = std::min(at_, text_.size());
        return trimmed(text_.substr(begin, at_ - begin));
    }

    void read_macro(std::string_view written, LSystemBlock& block) {
        const std::optional<LSystemBlock> inner = BlockReader(written, span_, names_, false).read();
        good_ = good_ && inner.has_value();
        if (inner) block.insert(block.end(), inner->begin(), inner->end());
    }

    void read_simple(LSystemBlock& block) {
        const std::string name(word());
        const std::string_view text = simple_text();
        if (text.empty()) {
            ++at_; // a brace that closes nothing
            return;
        }
        constexpr std::array printing = {"printf", "fprintf", "fflush", "fclose", "play"};
        if (std::ranges::find(printing, name) != printing.end())
            return names_.warn_once(span_, "what the model prints is left out");
        if (name == "srand") return names_.warn_once(span_, "srand() is left out: one seed decides all");
        const std::size_t equal = find_outside(text, "=");
        const bool assigns = !name.empty() && equal != std::string_view::npos &&
                             !text.substr(equal).starts_with("==") && text[equal - 1] != '!';
        constexpr std::array known_to_act = {"stop", "SetDerivationLength", "Display", "fscanf"};
        const bool acts = std::ranges::find(known_to_act, name) != known_to_act.end();
        const bool says_nothing = !assigns && !acts && equal == std::string_view::npos;
        if (says_nothing && expands_)
            if (const std::string written = names_.expanded(text, span_, false); written != text)
                return read_macro(written, block);
        if (says_nothing)
            return names_.warn_once(span_,
                                    fmt::format("'{}' changes nothing, and is left out", comment_text(text)));
        if (!assigns)
            return fail(fmt::format("'{}' has no translation here",
                                    name.empty() ? comment_text(text.substr(0, 20)) : name));
        const std::string_view value = trimmed(text.substr(equal + 1));
        if (value.starts_with("fopen")) return names_.warn_once(span_, "what the model prints is left out");
        LSystemAction action;
        action.name = names_.own_name(name);
        const std::string_view target = trimmed(text.substr(0, equal));
        action.target = target == name ? action.name : names_.expression(target, span_);
        action.value = names_.expression(value, span_);
        block.push_back(std::move(action));
    }

    std::string_view text_;
    Span span_;
    CpfgNames& names_;
    bool expands_;
    std::size_t at_ = 0;
    bool good_ = true;
};

void write(const LSystemBlock& block, std::string& out) {
    out += "{";
    bool ends = false; // a brace ends a statement by itself
    for (const LSystemAction& action : block) {
        out += out.ends_with("{") || ends ? " " : "; ";
        ends = action.kind == LSystemAction::Kind::branch || action.kind == LSystemAction::Kind::loop;
        switch (action.kind) {
        case LSystemAction::Kind::assign:
            out += fmt::format("{} = {}", action.target, action.value);
            break;
        case LSystemAction::Kind::branch:
            out += fmt::format("if ({}) ", action.value);
            write(action.then, out);
            if (!action.has_otherwise) break;
            out += " else ";
            write(action.otherwise, out);
            break;
        case LSystemAction::Kind::loop:
            out += fmt::format("while ({}) ", action.value);
            write(action.then, out);
            break;
        case LSystemAction::Kind::loop_after:
            out += "do ";
            write(action.then, out);
            out += fmt::format(" while ({})", action.value);
            break;
        }
    }
    out += out.ends_with("{") ? "}" : " }";
}

void each_assignment(const LSystemBlock& block, bool always,
                     const std::function<void(const LSystemAction&, bool)>& take) {
    for (const LSystemAction& action : block) {
        if (action.kind == LSystemAction::Kind::assign) take(action, always);
        each_assignment(action.then, false, take);
        each_assignment(action.otherwise, false, take);
    }
}

} // namespace

std::optional<LSystemBlock> read_cpfg_block(std::string_view text, Span span, CpfgNames& names) {
    return BlockReader(text, span, names).read();
}

std::string cpfg_block_text(const LSystemBlock& block) {
    std::string out;
    write(block, out);
    return out;
}

void each_assignment(const LSystemBlock& block, const std::function<void(const LSystemAction&, bool)>& take) {
    each_assignment(block, true, take);
}

bool names_any(std::string_view text, const std::function<bool(std::string_view)>& wanted) {
    for (std::size_t i = 0; i < text.size();) {
        if (!is_cpfg_name(text[i]) && text[i] != '.') {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (i < text.size() && (is_cpfg_name(text[i]) || text[i] == '.'))
            ++i;
        if (!std::isdigit(static_cast<unsigned char>(text[begin])) && wanted(text.substr(begin, i - begin)))
            return true;
    }
    return false;
}

bool is_random(std::string_view text) {
    return names_any(text, [](std::string_view name) { return name == "random" || name == "normal"; });
}

} // namespace graftal
