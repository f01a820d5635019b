#include "tests/fuzz/syntax_mutator.h"

#include <algorithm>
#include <array>
#include <optional>

namespace graftal::fuzz {

namespace {

using testing::Choices;

constexpr std::size_t most_kept = 512;
constexpr std::size_t longest_kept = 400;

/// At the edges of what is allowed, and beyond them.
constexpr auto numbers = std::to_array<std::string_view>({"0",
                                                          "1",
                                                          "2",
                                                          "3",
                                                          "7",
                                                          "64",
                                                          "255",
                                                          "256",
                                                          "1000",
                                                          "65536",
                                                          "0.5",
                                                          "0.1",
                                                          "0.999",
                                                          "1/3",
                                                          "1e-9",
                                                          "1e9",
                                                          "1e-17",
                                                          "1e100",
                                                          "1e-100",
                                                          "1.1e100",
                                                          "9e-101",
                                                          "1e308",
                                                          "5e-324",
                                                          "1e400",
                                                          "90",
                                                          "360",
                                                          "45",
                                                          "1e6",
                                                          "4294967295",
                                                          "4294967296",
                                                          "9007199254740993",
                                                          "18446744073709551616",
                                                          "2^1023",
                                                          "1e50",
                                                          "1e-50",
                                                          "-1"});

constexpr auto functions = std::to_array<std::string_view>(
    {"sqrt", "sin", "cos", "exp", "log", "abs", "floor", "random", "normal", "min", "max", "-", "!"});

constexpr auto operators = std::to_array<std::string_view>(
    {" + ", " - ", "*", "/", "^", " % ", " < ", " == ", " && ", " || ", " .. "});

template<typename List> const auto& one_of(const List& list, Choices& choices) {
    return list[choices.below(static_cast<std::uint32_t>(list.size()))];
}

/// A text, its tree, and one change to it.
class Editor {
  public:
    Editor(const std::string& text, const std::vector<SyntaxNode>& nodes, Choices& choices)
        : text_(text), nodes_(nodes), choices_(choices) {}

    /// A part: each kind is as likely as another, but numbers are more so and marks less. Null if there is
    /// none but the text.
    const SyntaxNode* choose() const {
        for (int attempt = 0; attempt < 8; ++attempt) {
            auto part = static_cast<Part>(1 + choices_.below(part_count - 1));
            if (part == Part::mark && !choices_.one_in(4)) part = Part::number;
            std::vector<const SyntaxNode*> all;
            for (const SyntaxNode& node : nodes_)
                if (node.part == part) all.push_back(&node);
            if (!all.empty()) return one_of(all, choices_);
        }
        return nullptr;
    }

    /// Another part of the kind, mostly one from the same place in its statement, and of the same key where
    /// there is one.
    const SyntaxNode* other(const SyntaxNode& than) const {
        std::vector<const SyntaxNode*> like, near, any;
        for (const SyntaxNode& node : nodes_) {
            if (node.part != than.part || &node == &than) continue;
            any.push_back(&node);
            if (node.within != than.within) continue;
            near.push_back(&node);
            if (node.key == than.key) like.push_back(&node);
        }
        const bool has_parts = than.part <= Part::call;
        if (has_parts && !like.empty() && choices_.one_in(2)) return one_of(like, choices_);
        if (!near.empty() && !choices_.one_in(8)) return one_of(near, choices_);
        return any.empty() || !choices_.one_in(2) ? nullptr : one_of(any, choices_);
    }

    std::string text_of(const SyntaxNode& node) const {
        return text_.substr(node.begin, node.end - node.begin);
    }

    std::string replaced(const SyntaxNode& node, std::string_view by) const {
        return text_.substr(0, node.begin) + std::string(by) + text_.substr(node.end);
    }

    /// What parts of the kind are parted by.
    static std::string_view separator(const SyntaxNode& node) {
        switch (node.part) {
        case Part::statement:
        case Part::block:
            return "\n";
        case Part::item:
        case Part::list:
            return ", ";
        case Part::number:
        case Part::word:
        case Part::string:
            return " ";
        default:
            return "";
        }
    }

    std::string without(const SyntaxNode& node) const {
        std::size_t begin = node.begin;
        if (node.part == Part::item) {
            const std::size_t before = text_.find_last_not_of(" \n\t", begin == 0 ? 0 : begin - 1);
            if (before != std::string::npos && before < begin && text_[before] == ',') begin = before;
        }
        return text_.substr(0, begin) + text_.substr(node.end);
    }

    /// With brackets it is what stands in them that grows, mostly.
    std::string with_more(const SyntaxNode& node, std::string_view more) const {
        const std::uint32_t copies = choices_.one_in(16) ? 1 + choices_.below(40) : 1;
        std::string added;
        const bool brackets = in_brackets(node) && !choices_.one_in(8);
        if (brackets && more.size() >= 2) more = more.substr(1, more.size() - 2);
        for (std::uint32_t i = 0; i < copies; ++i)
            added += std::string(separator(node)) + std::string(more);
        const std::size_t at = brackets ? node.end - 1 : node.end;
        return text_.substr(0, at) + added + text_.substr(at);
    }

    static bool in_brackets(const SyntaxNode& node) {
        return node.part == Part::block || node.part == Part::list || node.part == Part::branch;
    }

    std::string exchanged(const SyntaxNode& one, const SyntaxNode& two) const {
        const SyntaxNode &first = one.begin < two.begin ? one : two,
                         &last = one.begin < two.begin ? two : one;
        if (first.end > last.begin) return replaced(first, text_of(last)); // one lies in the other
        return text_.substr(0, first.begin) + text_of(last) +
               text_.substr(first.end, last.begin - first.end) + text_of(first) + text_.substr(last.end);
    }

    std::string nested(const SyntaxNode& node) const {
        const std::string inner = text_of(node);
        switch (node.part) {
        case Part::statement:
        case Part::block:
            return replaced(node, "{ " + inner + " }");
        case Part::branch:
        case Part::mark:
            return replaced(node, "[" + inner + "]");
        default:
            break;
        }
        const std::uint32_t times = choices_.one_in(16) ? 1 + choices_.below(60) : 1;
        const std::string_view function = one_of(functions, choices_);
        std::string outer, closers(times, ')');
        for (std::uint32_t i = 0; i < times; ++i)
            outer += std::string(function) + "(";
        return replaced(node, outer + inner + closers);
    }

    std::string combined(const SyntaxNode& node, std::string_view with) const {
        return replaced(node, text_of(node) + std::string(one_of(operators, choices_)) + std::string(with));
    }

    std::string other_number(const SyntaxNode& node) const {
        std::string number = text_of(node);
        switch (choices_.below(6)) {
        case 0:
            return replaced(node, "-" + number);
        case 1:
            return replaced(node, number + (choices_.one_in(2) ? "0" : "e-3"));
        case 2:
            if (const std::size_t digit = number.find_first_of("0123456789"); digit != std::string::npos)
                number[digit] = static_cast<char>('0' + choices_.below(10));
            return replaced(node, number);
        default:
            return replaced(node, one_of(numbers, choices_));
        }
    }

  private:
    const std::string& text_;
    const std::vector<SyntaxNode>& nodes_;
    Choices& choices_;
};

} // namespace

const SyntaxMutator::Kept* SyntaxMutator::kept_like(const SyntaxNode& node, Choices& choices) const {
    if (kept_.empty()) return nullptr;
    const std::size_t first = choices.below(static_cast<std::uint32_t>(kept_.size()));
    const bool any_key = choices.one_in(2), any_place = choices.one_in(8);
    for (std::size_t i = 0; i < kept_.size(); ++i) {
        const Kept& kept = kept_[(first + i) % kept_.size()];
        if (kept.part == node.part && (any_key || kept.key == node.key) &&
            (any_place || kept.within == node.within))
            return &kept;
    }
    return nullptr;
}

std::string SyntaxMutator::edit(const std::string& text, Choices& choices) const {
    const auto nodes = read_syntax(text);
    if (!nodes) return {};
    const Editor editor(text, *nodes, choices);
    const SyntaxNode* node = editor.choose();
    if (!node) return {};
    if (node->part == Part::number && !choices.one_in(3)) return editor.other_number(*node);
    const bool first_word = node->part == Part::word && node->key == node->within;
    if ((node->part == Part::mark || first_word) && !choices.one_in(6)) return {};
    const SyntaxNode* other = editor.other(*node);
    const Kept* kept = kept_like(*node, choices);
    switch (choices.below(8)) {
    case 0:
        return editor.without(*node);
    case 1:
        return editor.with_more(*node, editor.text_of(*node));
    case 2:
        return other ? editor.with_more(*node, editor.text_of(*other)) : std::string();
    case 3:
        return other ? editor.replaced(*node, editor.text_of(*other)) : std::string();
    case 4:
        return other ? editor.exchanged(*node, *other) : std::string();
    case 5:
        if (node->part == Part::statement || node->part == Part::block || node->part == Part::mark)
            return choices.one_in(12) ? editor.nested(*node) : std::string();
        if (choices.one_in(2)) return editor.nested(*node);
        return editor.combined(*node, other ? editor.text_of(*other) : std::string(one_of(numbers, choices)));
    case 6:
        return kept ? editor.replaced(*node, kept->text) : std::string();
    default:
        return kept ? editor.with_more(*node, kept->text) : std::string();
    }
}

std::string SyntaxMutator::mutate(std::string_view text, std::size_t most, Choices& choices) {
    std::string result(text);
    bool changed = false;
    std::uint32_t wanted = 1;
    while (wanted < 8 && choices.one_in(2))
        ++wanted;
    for (std::uint32_t attempt = 0; wanted > 0 && attempt < 32; ++attempt) {
        std::string edited = edit(result, choices);
        if (edited.empty() || edited.size() > most || edited == result) continue;
        result = std::move(edited);
        changed = true;
        --wanted;
    }
    return changed && result != text ? result : std::string();
}

void SyntaxMutator::learn(std::string_view text, Choices& choices) {
    const auto nodes = read_syntax(text);
    if (!nodes) return;
    for (const SyntaxNode& node : *nodes) {
        const bool splices =
            node.part == Part::statement || node.part == Part::call || node.part == Part::block;
        if (!splices || node.end - node.begin > longest_kept || !choices.one_in(4)) continue;
        Kept kept{node.part, std::string(node.key), std::string(node.within),
                  std::string(text.substr(node.begin, node.end - node.begin))};
        if (kept_.size() < most_kept)
            kept_.push_back(std::move(kept));
        else
            kept_[choices.below(most_kept)] = std::move(kept);
    }
}

} // namespace graftal::fuzz
