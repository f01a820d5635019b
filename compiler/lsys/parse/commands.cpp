#include "compiler/lsys/parse/commands.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

using Kind = LsysCommand::Kind;

/// Recursion is as deep as the braces, which TokenStream bounds.
class CommandParser {
  public:
    explicit CommandParser(TokenStream& stream) : stream_(stream) {}

    /// `{ command* }`
    bool parse_block(std::vector<LsysCommand>& commands) {
        const Token open = stream_.next();
        while (!stream_.at("}")) {
            if (stream_.at_end()) {
                stream_.expected("'}'").with_note(open.span, "to close this '{'");
                return false;
            }
            if (stream_.accept(";")) continue;
            if (!parse_command(commands.emplace_back())) return false;
        }
        stream_.next();
        return true;
    }

  private:
    bool parse_command(LsysCommand& command) {
        const Token first = stream_.peek();
        if (first.is("if")) return parse_if(command);
        if (first.is("while")) return parse_while(command);
        if (first.is("do")) return parse_do(command);
        if (first.is("else")) {
            stream_.expected("a statement").with_hint("'else' follows the '}' of an 'if'");
            return false;
        }
        return parse_assignment(command);
    }

    /// `x = number`, `a[i] = number`
    bool parse_assignment(LsysCommand& command) {
        if (!stream_.at_name()) {
            stream_.expected("a statement, such as x = 1");
            return false;
        }
        const bool known = stream_.peek(1).is("=") || stream_.peek(1).is("[");
        if (!known) return refuse_other();
        std::optional<Expression> target = parse_expression(stream_);
        if (!target) return false;
        if (target->kind != Expression::Kind::name && target->kind != Expression::Kind::element) {
            stream_.diagnostics().error(target->span,
                                        "only a name, or an element of an array, can be assigned");
            return false;
        }
        command.span = target->span;
        command.target = std::move(target->text);
        command.indices = std::move(target->operands);
        if (!stream_.expect("=", command.target)) return false;
        command.value = parse_expression(stream_);
        return command.value && end_statement();
    }

    /// Refuses the assignments of other languages.
    bool refuse_other() {
        const Token name = stream_.next();
        const Token& sign = stream_.peek();
        Diagnostic& error = stream_.expected(fmt::format("'=' after '{}'", name.text));
        const bool twice = sign.text == stream_.peek(1).text;
        if ((sign.is("+") || sign.is("-")) && twice)
            error.with_hint(fmt::format("write {0} = {0} {1} 1", name.text, sign.text));
        else if (stream_.peek(1).is("="))
            error.with_hint(fmt::format("write {0} = {0} {1} ...", name.text, sign.text));
        else if (sign.is("("))
            error.with_hint("a block assigns values, and calls nothing else");
        return false;
    }

    /// Ends a statement at the end of the line, at a ';' or before the '}'.
    bool end_statement() {
        if (stream_.accept(";") || stream_.at("}") || stream_.at_end() || stream_.peek().first_on_line)
            return true;
        Diagnostic& error = stream_.expected("';' or the end of the line");
        if (stream_.at("=")) error.with_hint("write equality as ==");
        return false;
    }

    /// `(number)`
    std::optional<Expression> parse_condition(const Token& word) {
        if (!stream_.expect("(", word.text)) return std::nullopt;
        std::optional<Expression> condition = parse_expression(stream_);
        if (!condition) return std::nullopt;
        if (stream_.accept(")")) return condition;
        Diagnostic& error = stream_.expected("')'");
        if (stream_.at("=")) error.with_hint("write equality as ==");
        return std::nullopt;
    }

    bool parse_arm(LsysCommandArm& arm, std::string_view after) {
        if (stream_.at("{")) return parse_block(arm.commands);
        stream_.expected(fmt::format("'{{' after {}", after))
            .with_hint("write braces even around one statement");
        return false;
    }

    bool parse_if(LsysCommand& command) {
        command.kind = Kind::choose;
        command.span = stream_.peek().span;
        while (true) {
            const Token word = stream_.next();
            LsysCommandArm& arm = command.arms.emplace_back();
            arm.condition = parse_condition(word);
            if (!arm.condition || !parse_arm(arm, "the condition")) return false;
            if (!stream_.accept("else")) return true;
            if (!stream_.at("if")) break;
        }
        return parse_arm(command.arms.emplace_back(), "'else'");
    }

    bool parse_while(LsysCommand& command) {
        command.kind = Kind::loop;
        const Token word = stream_.next();
        command.span = word.span;
        LsysCommandArm& arm = command.arms.emplace_back();
        arm.condition = parse_condition(word);
        return arm.condition && parse_arm(arm, "the condition");
    }

    bool parse_do(LsysCommand& command) {
        command.kind = Kind::loop_after;
        command.span = stream_.next().span;
        LsysCommandArm& arm = command.arms.emplace_back();
        if (!parse_arm(arm, "'do'")) return false;
        const Token word = stream_.peek();
        if (!stream_.expect("while", "the '}' of 'do'")) return false;
        arm.condition = parse_condition(word);
        return arm.condition && end_statement();
    }

    TokenStream& stream_;
};

} // namespace

bool parse_lsys_variables(TokenStream& stream, std::vector<LsysVariable>& variables) {
    do {
        const std::optional<Token> name = stream.expect_name("the name of a variable");
        if (!name) return false;
        if (stream.at("[")) {
            stream.expected("'='").with_hint("'array NAME[size]' declares an array");
            return false;
        }
        variables.push_back({{name->text, name->span}, {}, {}});
        if (!stream.expect("=", name->text)) return false;
        std::optional<Expression> value = parse_expression(stream);
        if (!value) return false;
        variables.back().values.push_back(std::move(*value));
    } while (stream.accept(","));
    return true;
}

bool parse_lsys_array(TokenStream& stream, std::vector<LsysVariable>& variables) {
    const std::optional<Token> name = stream.expect_name("the name of an array");
    if (!name) return false;
    if (!stream.at("[")) {
        stream.expected("'['").with_hint("write an array with its sizes: array a[3] = 1, 2, 3");
        return false;
    }
    LsysVariable array{{name->text, name->span}, {}, {}};
    while (stream.accept("[")) {
        std::optional<Expression> size = parse_expression(stream);
        if (!size || !stream.expect("]", "the size")) return false;
        array.sizes.push_back(std::move(*size));
    }
    LsysVariable& added = variables.emplace_back(std::move(array));
    if (!stream.accept("=")) return true;
    if (stream.at("{")) {
        stream.expected("a number").with_hint("write the values without braces, row by row");
        return false;
    }
    std::vector<Expression> values;
    do {
        std::optional<Expression> value = parse_expression(stream);
        if (!value) return false;
        values.push_back(std::move(*value));
    } while (stream.accept(","));
    added.values = std::move(values);
    return true;
}

std::optional<LsysCommands> parse_lsys_commands(TokenStream& stream) {
    LsysCommands commands;
    const Span open = stream.peek().span;
    if (!CommandParser(stream).parse_block(commands.list)) return std::nullopt;
    commands.span = stream.span_from(open);
    return commands;
}

} // namespace graftal
