#include "compiler/syntax/lsys_parser.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/syntax/lsys_block.h"

namespace graftal {

namespace {

void report_unknown(TokenStream& stream) {
    std::vector<std::string> words = scene_keywords();
    words.insert(words.end(), {"lsys", "main", "use"});
    const Token word = stream.peek();
    Diagnostic& error = stream.expected("'lsys', 'use' or a scene statement");
    if (word.kind == TokenKind::name) error.with_hint(did_you_mean(word.text, words));
    if (stream.next().is("{")) stream.skip_block();
    stream.skip_line();
}

/// Statements before, between and after the blocks.
void parse_outside(TokenStream stream, LsysFile& file) {
    while (!stream.at_end() && !stream.diagnostics().full()) {
        if (at_scene_statement(stream))
            parse_scene_statement(stream, file.statements);
        else if (!stream.at("use"))
            report_unknown(stream);
        else if (!parse_lsys_use(stream, file))
            stream.skip_line();
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
        parse_outside({std::move(tokens), diagnostics, header ? "'lsys'" : "the end of the file"}, tree);
        if (!header) break;
        at = parse_lsys_block(*header, text, tree);
    }
    return tree;
}

} // namespace graftal
