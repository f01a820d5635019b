#include "compiler/import/cfdg_parser.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg_tokens.h"

namespace graftal::cfdg {

namespace {

constexpr int deepest = 200; ///< of braces and brackets
constexpr int most_files = 32;

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

bool is_path_operation(std::string_view word) {
    static const std::set<std::string_view> words = {"MOVETO",  "LINETO", "ARCTO",    "CURVETO",  "MOVEREL",
                                                     "LINEREL", "ARCREL", "CURVEREL", "CLOSEPOLY"};
    return words.contains(word);
}

class Parser {
  public:
    Parser(const ForeignFile& file, Grammar& grammar, std::set<std::string>& files)
        : file_(file), grammar_(grammar), files_(files), tokens_(tokenize(file)) {}

    void run(bool included) {
        while (!at_end() && !file_.diagnostics.full())
            if (!parse_statement(included)) skip_to_statement();
        std::vector<std::string>& tail = grammar_.tail;
        tail.insert(tail.end(), peek().comments.begin(), peek().comments.end());
    }

  private:
    const Token& peek(std::size_t ahead = 0) const {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    bool at_end() const { return peek().kind == TokenKind::end; }
    bool at(std::string_view text) const { return peek().is(text); }

    const Token& next() {
        const Token& token = peek();
        if (at_ + 1 < tokens_.size()) ++at_;
        return token;
    }

    bool accept(std::string_view text) {
        if (!at(text)) return false;
        next();
        return true;
    }

    bool expected(std::string_view what) {
        file_.diagnostics.error(peek().span,
                                fmt::format("expected {}, found {}", what,
                                            at_end() ? peek().text : fmt::format("'{}'", peek().text)));
        return false;
    }

    bool expect(std::string_view text) { return accept(text) || expected(fmt::format("'{}'", text)); }

    /// Braces and brackets nest only so deep: the parser, and what walks the tree, recurs.
    class Level {
      public:
        explicit Level(Parser& parser) : parser_(parser), good_(++parser.depth_ <= deepest) {
            if (good_) return;
            if (!std::exchange(parser.too_deep_, true))
                parser.file_.diagnostics.error(
                    parser.peek().span, fmt::format("braces and brackets nest more than {} deep", deepest));
        }
        ~Level() { --parser_.depth_; }
        Level(const Level&) = delete;
        Level& operator=(const Level&) = delete;
        explicit operator bool() const { return good_; }

      private:
        Parser& parser_;
        bool good_;
    };

    void skip_to_statement() {
        static const std::set<std::string_view> begins = {"rule",    "shape",  "path",      "startshape",
                                                          "include", "import", "background"};
        int braces = 0;
        do {
            braces += at("{") ? 1 : at("}") ? -1 : 0;
            next();
        } while (!at_end() &&
                 !(braces <= 0 && peek().kind == TokenKind::word && begins.contains(peek().text)));
    }

    // Statements

    bool parse_statement(bool included) {
        if (at("startshape")) return parse_start(included);
        if (at("include") || at("import")) return parse_include();
        if (at("shape")) return parse_shape();
        if (at("path")) return parse_path();
        if (at("rule")) return parse_rule();
        if (peek().kind == TokenKind::word && (peek(1).is("{") || peek(1).is("[")))
            return parse_directive(included);
        if (peek().kind == TokenKind::word) return parse_definition();
        return expected("a statement");
    }

    bool parse_start(bool included) {
        Element start;
        start.comments = peek().comments;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of a shape");
        start.span = peek().span;
        start.name = next().text;
        if (at("(") && !parse_call_arguments(start)) return false;
        if ((at("[") || at("{")) && !parse_modification(start.modification)) return false;
        // The first counts, and one of the file itself before those of what it includes.
        if (!grammar_.start && !included) grammar_.start = start;
        if (!grammar_.included_start && included) grammar_.included_start = start;
        return true;
    }

    bool parse_include() {
        next();
        if (accept("@")) {
            file_.diagnostics.error(next().span, "namespaces of imports are not translated");
            return false;
        }
        const Span span = peek().span;
        if (peek().kind == TokenKind::end) return expected("the name of a file");
        const std::string name = peek().kind == TokenKind::text ? next().text : file_name_at(span);
        if (!files_.insert(name).second) return true;
        if (files_.size() > most_files) {
            file_.diagnostics.error(span, "too many files include each other");
            return false;
        }
        const std::optional<FileId> included = file_.read_beside ? file_.read_beside(name) : std::nullopt;
        if (!included) {
            file_.diagnostics.error(span, fmt::format("there is no file '{}' beside this one", name));
            return false;
        }
        const ForeignFile other{*included, file_.sources, file_.diagnostics, file_.read_beside};
        Parser(other, grammar_, files_).run(true);
        return true;
    }

    /// The rest of the word, up to white space; skips its tokens.
    std::string file_name_at(Span span) {
        const std::string_view text = file_.text();
        const std::size_t end = std::min(text.find_first_of(" \t\r\n", span.begin), text.size());
        while (!at_end() && peek().span.begin < end)
            next();
        return std::string(text.substr(span.begin, end - span.begin));
    }

    /// `background { b -1 }`, `size { s 10 }`, `tile { s 3 }` of version 2.
    bool parse_directive(bool included) {
        const Token word = next();
        Modification modification;
        if (!parse_modification(modification)) return false;
        std::optional<Modification>* const place = word.is("background")             ? &grammar_.background
                                                   : word.is("size") || word.is("s") ? &grammar_.size
                                                   : word.is("tile")                 ? &grammar_.tile
                                                                                     : nullptr;
        if (!place && !word.is("time")) {
            file_.diagnostics.error(word.span, fmt::format("unknown statement '{}'", word.text));
            return false;
        }
        if (place && !*place && !included) *place = std::move(modification);
        return true;
    }

    bool parse_definition() {
        Definition definition;
        definition.comments = peek().comments;
        definition.span = peek().span;
        definition.name = next().text;
        if (peek().kind == TokenKind::word && !at("=")) definition.name = next().text; // behind a type
        if (accept("(")) {
            definition.is_function = true;
            if (!parse_parameters(definition.parameters)) return false;
        }
        if (!expect("=")) return false;
        if (at("[")) {
            if (!parse_modification(definition.modification)) return false;
            definition.value.kind = Expr::Kind::modification;
            definition.value.span = definition.span;
        } else {
            std::optional<Expr> value = parse_list();
            if (!value) return false;
            definition.value = std::move(*value);
        }
        const auto place = [&]() -> std::optional<Modification>* {
            if (definition.name == "CF::Background") return &grammar_.background;
            if (definition.name == "CF::Size") return &grammar_.size;
            if (definition.name == "CF::Tile") return &grammar_.tile;
            return nullptr;
        }();
        if (place) {
            if (!*place) *place = std::move(definition.modification);
        } else if (std::ranges::none_of(grammar_.definitions, [&](const Definition& other) {
                       return other.name == definition.name;
                   })) {
            grammar_.definitions.push_back(std::move(definition));
        }
        return true;
    }

    /// Requires that the '(' was just taken.
    bool parse_parameters(std::vector<Parameter>& parameters) {
        if (accept(")")) return true;
        do {
            Parameter parameter{"number", {}, peek().span};
            if (peek().kind != TokenKind::word) return expected("a parameter");
            parameter.name = next().text;
            if (peek().kind == TokenKind::word) parameter.type = std::exchange(parameter.name, next().text);
            parameters.push_back(std::move(parameter));
        } while (accept(","));
        return expect(")");
    }

    Shape& shape_named(const std::string& name, Span span) {
        for (Shape& shape : grammar_.shapes)
            if (shape.name == name) return shape;
        Shape shape;
        shape.name = name;
        shape.span = span;
        grammar_.shapes.push_back(std::move(shape));
        return grammar_.shapes.back();
    }

    /// `shape NAME(parameters)`, and its rules or one body.
    bool parse_shape() {
        std::vector<std::string> comments = peek().comments;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of the shape");
        const Token name = next();
        std::vector<Parameter> parameters;
        if (accept("(") && !parse_parameters(parameters)) return false;
        if (at("=")) {
            file_.diagnostics.error(name.span, "functions that give shapes are not translated");
            return false;
        }
        Shape& shape = shape_named(name.text, name.span);
        shape.comments.insert(shape.comments.end(), comments.begin(), comments.end());
        if (shape.rules.empty()) shape.parameters = std::move(parameters);
        current_ = name.text;
        if (!at("{")) return true;
        Rule rule;
        rule.span = name.span;
        if (!parse_body(rule.body)) return false;
        shape_named(name.text, name.span).rules.push_back(std::move(rule));
        return true;
    }

    /// `rule 3 { ... }` of the shape above, or `rule NAME 3 { ... }` of version 2.
    bool parse_rule() {
        Rule rule;
        rule.comments = peek().comments;
        rule.span = next().span;
        std::string name = current_;
        if (peek().kind == TokenKind::word) {
            rule.span = peek().span;
            name = next().text;
        }
        if (peek().kind == TokenKind::number) {
            rule.weight = peek().number * (peek().percent ? 100 : 1);
            rule.percent = next().percent;
        }
        if (name.empty()) return expected("a 'shape' before this rule");
        if (!at("{")) return expected("'{'");
        if (!parse_body(rule.body)) return false;
        shape_named(name, rule.span).rules.push_back(std::move(rule));
        return true;
    }

    bool parse_path() {
        Rule rule;
        const std::vector<std::string> comments = peek().comments;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of the path");
        rule.span = peek().span;
        const std::string name = next().text;
        std::vector<Parameter> parameters;
        if (accept("(") && !parse_parameters(parameters)) return false;
        if (!at("{")) return expected("'{'");
        if (!parse_body(rule.body)) return false;
        Shape& shape = shape_named(name, rule.span);
        if (!shape.rules.empty()) {
            file_.diagnostics.error(rule.span, fmt::format("'{}' has another definition", name))
                .with_note(shape.span, "here");
            return false;
        }
        shape.is_path = true;
        shape.comments = comments;
        shape.parameters = std::move(parameters);
        shape.rules.push_back(std::move(rule));
        current_.clear();
        return true;
    }

    // Elements

    /// `{ ... }` or one element.
    bool parse_body(Elements& body) {
        const Level level(*this);
        if (!level) return false;
        if (!accept("{")) return parse_element(body);
        while (!accept("}")) {
            if (at_end()) return expected("'}'");
            if (!parse_element(body)) return false;
        }
        return true;
    }

    bool parse_element(Elements& elements) {
        if (accept(";")) return true;
        Element element;
        element.comments = peek().comments;
        element.span = peek().span;
        const auto done = [&] {
            element.span = join(element.span, tokens_[at_ - 1].span);
            elements.push_back(std::move(element));
            return true;
        };
        if (peek().kind == TokenKind::number && peek(1).is("*")) {
            element.kind = Element::Kind::loop;
            element.arguments.push_back({.number = peek().number, .span = peek().span});
            next();
            next();
            return parse_modification(element.modification) && parse_body(element.body) && done();
        }
        if (accept("loop")) return parse_loop(element) && done();
        if (at("if") && peek(1).is("(")) return parse_if(element) && done();
        if (at("switch")) return parse_switch(element) && done();
        if (at("clone")) {
            file_.diagnostics.error(peek().span, "'clone' is not translated").with_hint("use 'transform'");
            return false;
        }
        if (at("let")) {
            file_.diagnostics.error(peek().span, "'let' within a rule is not translated");
            return false;
        }
        if (at("transform") || at("trans")) return parse_transform(element) && done();
        if (peek().kind != TokenKind::word) return expected("a shape");
        if (peek(1).is("=") || (peek(1).kind == TokenKind::word && peek(2).is("=")))
            return parse_local(element) && done();
        accept("path");
        element.name = next().text;
        if (element.name.find("::") != std::string::npos) {
            file_.diagnostics.error(element.span,
                                    fmt::format("the name space of '{}' is not translated", element.name));
            return false;
        }
        if (is_path_operation(element.name)) {
            element.kind = Element::Kind::path_operation;
            if (at("(")) return parse_call_arguments(element) && done();
            return parse_modification(element.modification) && done();
        }
        if (at("(") && !parse_call_arguments(element)) return false;
        return parse_modification(element.modification) && done();
    }

    bool parse_loop(Element& element) {
        element.kind = Element::Kind::loop;
        if (peek().kind == TokenKind::word && peek(1).is("=")) {
            element.name = next().text;
            next();
        }
        do {
            std::optional<Expr> bound = parse_expression();
            if (!bound) return false;
            element.arguments.push_back(std::move(*bound));
        } while (accept(","));
        if (!parse_modification(element.modification) || !parse_body(element.body)) return false;
        return !accept("finally") || parse_body(element.other);
    }

    bool parse_if(Element& element) {
        next();
        next();
        element.kind = Element::Kind::condition;
        std::optional<Expr> test = parse_expression();
        if (!test || !expect(")")) return false;
        element.arguments.push_back(std::move(*test));
        if (!parse_body(element.body)) return false;
        return !accept("else") || parse_body(element.other);
    }

    bool parse_switch(Element& element) {
        next();
        element.kind = Element::Kind::choice;
        if (!expect("(")) return false;
        std::optional<Expr> value = parse_expression();
        if (!value || !expect(")") || !expect("{")) return false;
        element.arguments.push_back(std::move(*value));
        while (!accept("}")) {
            Case one;
            if (accept("case")) {
                do {
                    std::optional<Expr> label = parse_expression();
                    if (!label) return false;
                    one.values.push_back(std::move(*label));
                } while (accept(","));
            } else if (!accept("else")) {
                return expected("'case', 'else' or '}'");
            }
            if (!expect(":") || !parse_body(one.body)) return false;
            element.cases.push_back(std::move(one));
        }
        return true;
    }

    bool parse_transform(Element& element) {
        next();
        element.kind = Element::Kind::transform;
        do {
            Modification modification;
            if (!parse_modification(modification)) return false;
            element.modifications.push_back(std::move(modification));
        } while (accept(","));
        return parse_body(element.body);
    }

    bool parse_local(Element& element) {
        element.kind = Element::Kind::define;
        element.name = next().text;
        if (!at("=")) element.name = next().text;
        next();
        if (at("[")) {
            if (!parse_modification(element.modification)) return false;
            element.arguments.push_back({.kind = Expr::Kind::modification, .span = element.span});
            return true;
        }
        std::optional<Expr> value = parse_list();
        if (!value) return false;
        element.arguments.push_back(std::move(*value));
        return true;
    }

    /// Requires that the stream is at the '('.
    bool parse_call_arguments(Element& element) {
        next();
        if (accept("=")) {
            element.reuses_arguments = true;
            return expect(")");
        }
        if (accept(")")) return true;
        do {
            std::optional<Expr> argument = parse_expression();
            if (!argument) return false;
            element.arguments.push_back(std::move(*argument));
        } while (accept(","));
        return expect(")");
    }

    // Adjustments

    bool parse_modification(Modification& modification) {
        modification.span = peek().span;
        const bool brackets = at("["), twice = brackets && peek(1).is("[");
        if (!brackets && !at("{")) return expected("'[' or '{'");
        next();
        if (twice) next();
        const std::string_view close = brackets ? "]" : "}";
        while (!at(close)) {
            if (at_end()) return expected(fmt::format("'{}'", close));
            if (!parse_adjustment(modification)) return false;
        }
        next();
        if (twice && !expect("]")) return false;
        modification.ordered = twice || (brackets && version_2());
        modification.span = join(modification.span, tokens_[at_ - 1].span);
        return true;
    }

    /// In version 2, brackets keep the order of adjustments.
    bool version_2() const {
        if (!is_version_2_)
            is_version_2_ = std::ranges::none_of(tokens_, [](const Token& token) {
                return token.is("shape") || token.is("loop") || token.is("import") || token.is("=");
            });
        return *is_version_2_;
    }

    bool parse_adjustment(Modification& modification) {
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
    std::string_view word_of(std::string_view word) const {
        static const std::set<std::string_view> old = {"param", "p",  "width", "x1", "y1",
                                                       "x2",    "y2", "rx",    "ry"};
        return old.contains(word) && !version_2() ? std::string_view() : adjustment_word(word);
    }

    /// Whether a number goes on: words of adjustments do not.
    bool begins_value() const {
        if (peek().kind == TokenKind::number || at("(") || at("-") || at("+")) return true;
        return peek().kind == TokenKind::word && peek().text[0] != '|' && word_of(peek().text).empty();
    }

    // Expressions

    /// A number of an adjustment: signs in between stand in parentheses only.
    std::optional<Expr> parse_value() {
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
    std::optional<Expr> parse_list() {
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

    static int level_of(const Token& token) {
        static const std::map<std::string_view, int> levels = {
            {"&&", 1}, {"||", 1},  {"^^", 1}, {"<", 2}, {"<=", 2}, {">", 2},  {">=", 2}, {"==", 2}, {"<>", 2},
            {"..", 3}, {"+/-", 3}, {"+", 4},  {"-", 4}, {"_", 4},  {"--", 4}, {"*", 5},  {"/", 5},  {"^", 6}};
        if (token.kind != TokenKind::sign && token.text != "_") return 0;
        const auto found = levels.find(token.text);
        return found == levels.end() ? 0 : found->second;
    }

    static Expr binary(const Token& sign, Expr left, Expr right) {
        Expr expression{.kind = Expr::Kind::binary, .text = sign.text == "--" ? "_" : sign.text};
        expression.span = join(left.span, right.span);
        expression.operands.push_back(std::move(left));
        expression.operands.push_back(std::move(right));
        return expression;
    }

    std::optional<Expr> parse_expression(int least = 1) {
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
    bool chain_too_long(const Expr& expression) {
        int depth = 0;
        for (const Expr* at = &expression; at->kind == Expr::Kind::binary; at = &at->operands[0])
            if (++depth > 4 * deepest) {
                file_.diagnostics.error(expression.span, "this expression is too long");
                return true;
            }
        return false;
    }

    /// `tight`: of an adjustment, where a sign takes the next number only.
    std::optional<Expr> parse_unary(bool tight) {
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
            file_.diagnostics.error(peek().span, "an adjustment cannot be a number here");
            return std::nullopt;
        }
        if (peek().kind != TokenKind::word) {
            expected("a number");
            return std::nullopt;
        }
        Expr name{.kind = Expr::Kind::name, .text = peek().text, .span = peek().span};
        next();
        if (at("[") && peek().span.begin == name.span.end) { // an element of a vector
            next();
            std::optional<Expr> index = parse_expression();
            if (!index || !expect("]")) return std::nullopt;
            Expr element{
                .kind = Expr::Kind::call, .text = "[]", .span = join(name.span, tokens_[at_ - 1].span)};
            element.operands.push_back(std::move(name));
            element.operands.push_back(std::move(*index));
            return element;
        }
        if (!at("(")) return name;
        next();
        name.kind = Expr::Kind::call;
        if (name.text == "let") return parse_let(std::move(name));
        if (!accept(")")) {
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
    std::optional<Expr> parse_let(Expr let) {
        while (peek().kind == TokenKind::word && peek(1).is("=")) {
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

    const ForeignFile& file_;
    Grammar& grammar_;
    std::set<std::string>& files_;
    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    int depth_ = 0;
    bool too_deep_ = false;
    std::size_t size_ = 0;
    std::string current_; ///< the shape that a rule belongs to
    mutable std::optional<bool> is_version_2_;
};

} // namespace

Grammar parse(const ForeignFile& file) {
    Grammar grammar;
    std::set<std::string> files;
    Parser(file, grammar, files).run(false);
    if (!grammar.start) grammar.start = grammar.included_start;
    return grammar;
}

} // namespace graftal::cfdg
