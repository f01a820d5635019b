#include "compiler/lsys/lsys_parser.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/lsys/lsys_block.h"

namespace graftal {

namespace {

std::string hint_outside(const TokenStream& stream) {
    const Token& word = stream.peek();
    if (word.kind != TokenKind::name) return {};
    if (is_lsys_keyword(word.text) || stream.peek(1).is("->"))
        return "write the statements of an L-system in a block: lsys NAME { ... }";
    if (word.is("rifs") || word.is("object") || word.is("canonical"))
        return fmt::format("name the file of such a model with the extension .{}",
                           word.is("rifs") ? "rifs" : "inst");
    if (stream.peek(1).is("{")) return fmt::format("begin a block with its kind: lsys {} {{", word.text);
    if (stream.peek(1).is("=")) return fmt::format("'let {} = ...' names a number", word.text);
    std::vector<std::string> words = {"lsys", "main", "use"};
    words.insert(words.end(), scene_keywords().begin(), scene_keywords().end());
    return choices(word.text, words);
}

/// A run of lines that are no statements here is reported once.
void skip_unknown(TokenStream& stream, bool report) {
    if (report) stream.expected("'lsys', 'use' or a scene statement").with_hint(hint_outside(stream));
    do {
        if (stream.next().is("{")) stream.skip_block();
    } while (!stream.at_end() && !stream.peek().first_on_line);
}

/// Statements before, between and after the blocks. `lost_braces`: of so many '}' the '{' was not understood.
void parse_outside(TokenStream stream, LsysFile& file, std::size_t lost_braces) {
    stream.drop_semicolons();
    bool lost = false;
    while (!stream.at_end() && !stream.diagnostics().full()) {
        const bool known = at_scene_statement(stream) || stream.at("use");
        if (stream.at("}") && lost_braces > 0) {
            --lost_braces;
            stream.next();
        } else if (!known) {
            skip_unknown(stream, !lost);
        } else if (stream.at("use")) {
            if (!parse_lsys_use(stream, file)) stream.skip_line();
        } else {
            parse_scene_statement(stream, file.statements);
        }
        lost = !known;
    }
}

} // namespace

bool parse_lsys_use(TokenStream& stream, LsysFile& file) {
    stream.next();
    const std::optional<Token> name = stream.expect_name("a name after 'use'");
    if (!name || !stream.expect("=", name->text)) return false;
    const std::optional<Token> path = stream.expect_string("the file name in quotes");
    if (!path) return false;
    file.uses.push_back({{name->text, name->span}, path->text, path->span});
    return true;
}

LsysFile parse_lsys(const SourceMap& sources, FileId file, Diagnostics& diagnostics) {
    LsysFile tree;
    const LsysScanner scanner(sources, file, diagnostics);
    LsysText text{sources, scanner, diagnostics, {}};
    std::size_t at = 0;
    while (!diagnostics.full()) {
        const std::optional<LsysHeader> header = scanner.find_block(at);
        const std::size_t end = header ? header->begin : scanner.text().size();
        std::vector<Token> tokens = lex_range(sources, scanner.span(at, end), diagnostics);
        parse_outside({std::move(tokens), diagnostics, header ? "'lsys'" : "the end of the file"}, tree,
                      text.lost_braces);
        if (!header) break;
        at = parse_lsys_block(*header, text, tree);
    }
    return tree;
}

} // namespace graftal
