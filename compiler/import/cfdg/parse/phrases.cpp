#include "compiler/import/cfdg/parse/phrases.h"

#include <map>
#include <set>

namespace graftal::cfdg {

namespace {

/// The short name of an adjustment; "" if the word is none.
std::string_view adjustment_word(std::string_view word) {
    static const std::map<std::string_view, std::string_view> words = {
        {"x", "x"},         {"y", "y"},
        {"z", "z"},         {"r", "r"},
        {"rotate", "r"},    {"s", "s"},
        {"size", "s"},      {"skew", "skew"},
        {"f", "f"},         {"flip", "f"},
        {"h", "h"},         {"hue", "h"},
        {"sat", "sat"},     {"saturation", "sat"},
        {"b", "b"},         {"brightness", "b"},
        {"a", "a"},         {"alpha", "a"},
        {"trans", "trans"}, {"transform", "trans"},
        {"time", "time"},   {"timescale", "timescale"},
        {"blend", "blend"}, {"width", "width"},
        {"param", "p"},     {"p", "p"},
        {"x1", "x1"},       {"y1", "y1"},
        {"x2", "x2"},       {"y2", "y2"},
        {"rx", "rx"},       {"ry", "ry"}};
    const auto found = words.find(word);
    return found == words.end() ? std::string_view() : found->second;
}

} // namespace

bool Phrases::parse_modification(Modification& modification) {
    modification.span = peek().span;
    const bool brackets = at("["), twice = brackets && peek(1).is("[");
    if (!brackets && !at("{")) return expected("'[' or '{'");
    next();
    if (twice) next();
    const std::string_view close = brackets ? "]" : "}";
    while (!at(close)) {
        if (at_end()) return expected(fmt::format("'{}'", close));
        if (version_2() && accept(";")) continue;
        if (!parse_adjustment(modification)) return false;
    }
    next();
    if (twice && !expect("]")) return false;
    modification.ordered = twice || (brackets && version_2());
    modification.span = join(modification.span, tokens_[at_ - 1].span);
    return true;
}

/// In version 2, brackets keep the order of adjustments.
bool Phrases::version_2() const {
    if (!is_version_2_)
        is_version_2_ = std::ranges::none_of(tokens_, [](const Token& token) {
            return token.is("shape") || token.is("loop") || token.is("import") || token.is("=");
        });
    return *is_version_2_;
}

bool Phrases::parse_adjustment(Modification& modification) {
    Adjustment adjustment;
    adjustment.span = peek().span;
    if (peek().kind != TokenKind::word) return expected("an adjustment, such as x, s, r or hue");
    std::string_view word = peek().text;
    adjustment.sets_target = word.starts_with('|');
    if (adjustment.sets_target) word.remove_prefix(1);
    adjustment.word = word_of(word);
    if (adjustment.word.empty()) return expected("an adjustment, such as x, s, r or hue");
    next();
    if (adjustment.word == "p") {
        adjustment.values.push_back({.kind = Expr::Kind::name, .text = peek().text, .span = peek().span});
        next();
    } else {
        while (begins_value()) {
            std::optional<Expr> value = parse_value();
            if (!value) return false;
            adjustment.values.push_back(std::move(*value));
        }
        if (adjustment.values.empty()) return expected(fmt::format("a number after '{}'", word));
        adjustment.to_target = accept("|");
    }
    adjustment.span = join(adjustment.span, tokens_[at_ - 1].span);
    modification.adjustments.push_back(std::move(adjustment));
    return true;
}

/// Some words are adjustments in paths of version 2 only.
std::string_view Phrases::word_of(std::string_view word) const {
    static const std::set<std::string_view> old = {"param", "p", "width", "x1", "y1", "x2", "y2", "rx", "ry"};
    return old.contains(word) && !version_2() ? std::string_view() : adjustment_word(word);
}

/// Whether a number goes on: words of adjustments do not.
bool Phrases::begins_value() const {
    if (peek().kind == TokenKind::number || at("(") || at("-") || at("+")) return true;
    return peek().kind == TokenKind::word && peek().text[0] != '|' && word_of(peek().text).empty();
}

// Expressions

/// A number of an adjustment: signs in between stand in parentheses only.
std::optional<Expr> Phrases::parse_value() {
    std::optional<Expr> left = parse_unary(true);
    while (left && (at("..") || at("+/-"))) {
        const Token sign = next();
        std::optional<Expr> right = parse_unary(true);
        if (!right) return std::nullopt;
        left = binary(sign, std::move(*left), std::move(*right));
    }
    return left;
}

/// `a` or `a, b`.
std::optional<Expr> Phrases::parse_list() {
    std::optional<Expr> first = parse_expression();
    if (!first || !at(",")) return first;
    Expr list{.kind = Expr::Kind::list, .span = first->span};
    list.operands.push_back(std::move(*first));
    while (accept(",")) {
        std::optional<Expr> more = parse_expression();
        if (!more) return std::nullopt;
        list.operands.push_back(std::move(*more));
    }
    return list;
}

int Phrases::level_of(const Token& token) {
    static const std::map<std::string_view, int> levels = {
        {"&&", 1}, {"||", 1},  {"^^", 1}, {"<", 2}, {"<=", 2}, {">", 2},  {">=", 2}, {"==", 2}, {"<>", 2},
        {"..", 3}, {"+/-", 3}, {"+", 4},  {"-", 4}, {"_", 4},  {"--", 4}, {"*", 5},  {"/", 5},  {"^", 6}};
    if (token.kind != TokenKind::sign && token.text != "_") return 0;
    const auto found = levels.find(token.text);
    return found == levels.end() ? 0 : found->second;
}

Expr Phrases::binary(const Token& sign, Expr left, Expr right) {
    Expr expression{.kind = Expr::Kind::binary, .text = sign.text == "--" ? "_" : sign.text};
    expression.span = join(left.span, right.span);
    expression.operands.push_back(std::move(left));
    expression.operands.push_back(std::move(right));
    return expression;
}

std::optional<Expr> Phrases::parse_expression(int least) {
    const Level level(*this);
    if (!level) return std::nullopt;
    std::optional<Expr> left = parse_unary(false);
    while (left) {
        const int strength = level_of(peek());
        if (strength < least || strength == 0) break;
        const Token sign = next();
        std::optional<Expr> right = parse_expression(sign.text == "^" ? strength : strength + 1);
        if (!right) return std::nullopt;
        if (++size_ > 200'000) {
            file_.diagnostics.error(sign.span, "the expressions of the file are too long");
            return std::nullopt;
        }
        left = binary(sign, std::move(*left), std::move(*right));
        if (chain_too_long(*left)) return std::nullopt;
    }
    return left;
}

/// A row of operators makes a tree as deep as it is long.
bool Phrases::chain_too_long(const Expr& expression) {
    int depth = 0;
    for (const Expr* at = &expression; at->kind == Expr::Kind::binary; at = &at->operands[0])
        if (++depth > 4 * deepest) {
            file_.diagnostics.error(expression.span, "this expression is too long");
            return true;
        }
    return false;
}

/// `tight`: of an adjustment, where a sign takes the next number only.
std::optional<Expr> Phrases::parse_unary(bool tight) {
    const Level level(*this);
    if (!level) return std::nullopt;
    if (at("-") || at("+") || at("!")) {
        const Token sign = next();
        std::optional<Expr> operand = tight ? parse_unary(true) : parse_expression(6);
        if (!operand || sign.text == "+") return operand;
        Expr expression{.kind = Expr::Kind::unary, .text = sign.text};
        expression.span = join(sign.span, operand->span);
        expression.operands.push_back(std::move(*operand));
        return expression;
    }
    if (at("(")) {
        next();
        std::optional<Expr> inner = parse_list();
        if (!inner || !expect(")")) return std::nullopt;
        return inner;
    }
    if (peek().kind == TokenKind::number) {
        const Token& token = next();
        return Expr{.number = token.number, .span = token.span};
    }
    if (at("[")) {
        Modification change;
        if (!parse_modification(change)) return std::nullopt;
        Expr expression{.kind = Expr::Kind::modification, .span = change.span};
        expression.change = std::make_shared<const Modification>(std::move(change));
        return expression;
    }
    if (peek().kind != TokenKind::word) {
        expected("a number");
        return std::nullopt;
    }
    Expr name{.kind = Expr::Kind::name, .text = peek().text, .span = peek().span};
    next();
    if (at("[") && peek().span.begin == name.span.end) { // an element of a vector
        next();
        Expr element{.kind = Expr::Kind::call, .text = "[]", .span = name.span};
        element.operands.push_back(std::move(name));
        do {
            std::optional<Expr> index = parse_expression();
            if (!index) return std::nullopt;
            element.operands.push_back(std::move(*index));
        } while (accept(","));
        if (!expect("]")) return std::nullopt;
        element.span = join(element.span, tokens_[at_ - 1].span);
        return element;
    }
    if (!at("(")) return name;
    next();
    name.kind = Expr::Kind::call;
    if (name.text == "let") return parse_let(std::move(name));
    if (accept("=")) { // with the parameters of the rule
        name.operands.push_back({.kind = Expr::Kind::name, .text = "=", .span = name.span});
        if (!expect(")")) return std::nullopt;
    } else if (!accept(")")) {
        do {
            std::optional<Expr> argument = parse_expression();
            if (!argument) return std::nullopt;
            name.operands.push_back(std::move(*argument));
        } while (accept(","));
        if (!expect(")")) return std::nullopt;
    }
    name.span = join(name.span, tokens_[at_ - 1].span);
    return name;
}

/// `let(a = 1; b = 2; a + b)`, behind its '('.
std::optional<Expr> Phrases::parse_let(Expr let) {
    while (peek().kind == TokenKind::word &&
           (peek(1).is("=") || (peek(1).kind == TokenKind::word && peek(2).is("=")))) {
        if (!peek(1).is("=")) next(); // a type
        Expr local{.kind = Expr::Kind::binary, .text = "=", .span = peek().span};
        local.operands.push_back({.kind = Expr::Kind::name, .text = next().text, .span = local.span});
        next();
        std::optional<Expr> value = parse_list();
        if (!value || !expect(";")) return std::nullopt;
        local.operands.push_back(std::move(*value));
        let.operands.push_back(std::move(local));
    }
    std::optional<Expr> value = parse_list();
    if (!value || !expect(")")) return std::nullopt;
    let.operands.push_back(std::move(*value));
    let.span = join(let.span, tokens_[at_ - 1].span);
    return let;
}

} // namespace graftal::cfdg
