#include "compiler/import/cfdg/parse/parser.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cfdg/parse/phrases.h"

namespace graftal::cfdg {

namespace {

constexpr int most_files = 32;

bool is_path_operation(std::string_view word) {
    static const std::set<std::string_view> words = {"MOVETO",  "LINETO", "ARCTO",    "CURVETO",  "MOVEREL",
                                                     "LINEREL", "ARCREL", "CURVEREL", "CLOSEPOLY"};
    return words.contains(word);
}

class Parser : private Phrases {
  public:
    Parser(const ForeignFile& file, Grammar& grammar, std::set<std::string>& files, std::string space)
        : Phrases(file), grammar_(grammar), files_(files), space_(std::move(space)) {}

    void run(bool included) {
        while (!at_end() && !file_.diagnostics.full())
            if (!parse_statement(included)) skip_to_statement();
        std::vector<std::string>& tail = grammar_.tail;
        tail.insert(tail.end(), peek().comments.begin(), peek().comments.end());
    }

  private:
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
        if (at("shape")) return parse_shape(included);
        if (at("path")) return parse_path();
        if (at("rule")) return parse_rule();
        if (peek().kind == TokenKind::word && (peek(1).is("{") || peek(1).is("[")))
            return parse_directive(included);
        if (peek().kind == TokenKind::word) return parse_definition(included);
        return expected("a statement");
    }

    bool parse_start(bool included) {
        Element start;
        start.comments = peek().comments;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of a shape");
        start.span = peek().span;
        start.name = space_ + next().text;
        if (at("(") && !parse_call_arguments(start)) return false;
        if ((at("[") || at("{")) && !parse_modification(start.modification)) return false;
        return keep_start(std::move(start), included);
    }

    /// The first counts, and one of the file itself before those of what it includes.
    bool keep_start(Element start, bool included) {
        std::optional<Element>& place = included ? grammar_.included_start : grammar_.start;
        if (!place) place = std::move(start);
        return true;
    }

    bool parse_include() {
        next();
        std::string space = space_;
        if (accept("@")) {
            if (peek().kind != TokenKind::word) return expected("the name of a name space");
            space += next().text + "::";
        }
        const Span span = peek().span;
        if (peek().kind == TokenKind::end) return expected("the name of a file");
        const std::string name = peek().kind == TokenKind::text ? next().text : file_name_at(span);
        if (!files_.insert(space + name).second) return true;
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
        Parser(other, grammar_, files_, space).run(true);
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

    bool parse_definition(bool included) {
        Definition definition;
        definition.comments = peek().comments;
        definition.span = peek().span;
        definition.name = next().text;
        if (peek().kind == TokenKind::word) definition.type = std::exchange(definition.name, next().text);
        return parse_definition(std::move(definition), included);
    }

    /// Parses a definition behind its name.
    bool parse_definition(Definition definition, bool included) {
        if (accept("(")) {
            definition.is_function = true;
            if (!parse_parameters(definition.parameters)) return false;
        }
        if (!expect("=")) return false;
        std::optional<Expr> value = parse_list();
        if (!value) return false;
        definition.value = std::move(*value);
        if (definition.name == "CF::StartShape") return start_from(definition.value, included);
        definition.space = space_;
        if (!definition.name.starts_with("CF::")) definition.name.insert(0, space_);
        const auto place = [&]() -> std::optional<Modification>* {
            if (definition.name == "CF::Background") return &grammar_.background;
            if (definition.name == "CF::Size") return &grammar_.size;
            if (definition.name == "CF::Tile") return &grammar_.tile;
            return nullptr;
        }();
        if (place) {
            if (definition.value.kind != Expr::Kind::modification) {
                file_.diagnostics.error(definition.span,
                                        fmt::format("'{}' takes an adjustment", definition.name));
                return false;
            }
            if (!*place) *place = *definition.value.change;
        } else if (grammar_.defined.insert(definition.name).second) {
            grammar_.definitions.push_back(std::move(definition));
        }
        return true;
    }

    /// `CF::StartShape = a(1, 2), [x 1]`.
    bool start_from(const Expr& value, bool included) {
        const bool list = value.kind == Expr::Kind::list;
        const Expr& shape = list ? value.operands.front() : value;
        Element start;
        start.span = value.span;
        start.name = space_ + shape.text;
        start.arguments = shape.operands;
        const bool named = shape.kind == Expr::Kind::name || shape.kind == Expr::Kind::call;
        const Expr* const change = list && value.operands.size() == 2 ? &value.operands[1] : nullptr;
        if (!named || (list && !(change && change->kind == Expr::Kind::modification))) {
            file_.diagnostics.error(value.span, "'CF::StartShape' takes a shape, and perhaps an adjustment");
            return false;
        }
        if (change) start.modification = *change->change;
        return keep_start(std::move(start), included);
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
        const auto [found, fresh] = grammar_.numbers.try_emplace(name, grammar_.shapes.size());
        if (!fresh) return grammar_.shapes[found->second];
        Shape shape;
        shape.name = name;
        shape.space = space_;
        shape.span = span;
        grammar_.shapes.push_back(std::move(shape));
        return grammar_.shapes.back();
    }

    /// `shape NAME(parameters)`, and its rules or one body.
    bool parse_shape(bool included) {
        std::vector<std::string> comments = peek().comments;
        next();
        if (peek().kind != TokenKind::word) return expected("the name of the shape");
        Token name = next();
        if (at("(") || at("=")) {
            // A function that gives shapes looks like a shape up to its '='.
            const std::size_t before = at_;
            std::vector<Parameter> parameters;
            if (accept("(") && !parse_parameters(parameters)) return false;
            if (accept("=")) {
                at_ = before;
                Definition function{.name = name.text, .type = "shape", .span = name.span};
                function.is_function = accept("(");
                if (function.is_function && !parse_parameters(function.parameters)) return false;
                return parse_definition(std::move(function), included);
            }
            at_ = before;
        }
        name.text.insert(0, space_);
        std::vector<Parameter> parameters;
        if (accept("(") && !parse_parameters(parameters)) return false;
        Shape& shape = shape_named(name.text, name.span);
        shape.comments.insert(shape.comments.end(), comments.begin(), comments.end());
        if (shape.rules.empty() && !parameters.empty()) shape.parameters = std::move(parameters);
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
            name = space_ + next().text;
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
        const std::string name = space_ + next().text;
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
        if (at("let") && peek(1).is("(")) return parse_computed(element) && done();
        if (at("switch")) return parse_switch(element) && done();
        if (at("transform") || at("trans") || at("clone")) return parse_transform(element) && done();
        if (peek().kind != TokenKind::word) return expected("a shape");
        if (peek(1).is("=") || (peek(1).kind == TokenKind::word && peek(2).is("=")))
            return parse_local(element) && done();
        accept("path");
        element.name = next().text;
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
        const std::size_t begin = at_;
        next();
        next();
        element.kind = Element::Kind::condition;
        std::optional<Expr> test = parse_list();
        if (!test || !expect(")")) return false;
        if (test->kind == Expr::Kind::list && at("[")) {
            at_ = begin;
            return parse_computed(element);
        }
        element.arguments.push_back(std::move(*test));
        if (!parse_body(element.body)) return false;
        return !accept("else") || parse_body(element.other);
    }

    /// `if(a, B, C) []` or `let(...) []`: an expression that gives the shape.
    bool parse_computed(Element& element) {
        element.kind = Element::Kind::shape;
        element.computed = true;
        std::optional<Expr> shape = parse_expression();
        if (!shape) return false;
        element.arguments.push_back(std::move(*shape));
        return parse_modification(element.modification);
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
        element.clones = next().is("clone");
        element.kind = Element::Kind::transform;
        do {
            std::optional<Expr> change = parse_expression();
            if (!change) return false;
            element.arguments.push_back(std::move(*change));
        } while (accept(","));
        return parse_body(element.body);
    }

    bool parse_local(Element& element) {
        element.kind = Element::Kind::define;
        element.name = next().text;
        if (!at("=")) element.name = next().text;
        next();
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

    Grammar& grammar_;
    std::set<std::string>& files_;
    std::string space_;   ///< of the names of the file: "a::b::"
    std::string current_; ///< the shape that a rule belongs to
};

} // namespace

std::optional<std::size_t> Grammar::shape(std::string_view name, std::string_view space) const {
    return in_spaces(name, space, [&](const std::string& full) -> std::optional<std::size_t> {
        const auto found = numbers.find(full);
        return found == numbers.end() ? std::nullopt : std::optional(found->second);
    });
}

Grammar parse(const ForeignFile& file) {
    Grammar grammar;
    std::set<std::string> files;
    Parser(file, grammar, files, "").run(false);
    if (!grammar.start) grammar.start = grammar.included_start;
    return grammar;
}

} // namespace graftal::cfdg
