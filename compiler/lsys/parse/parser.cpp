#include "compiler/lsys/parse/parser.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/lsys/parse/block.h"

namespace graftal {

namespace {

std::string hint_outside(const TokenStream& stream, const ForeignWords& foreign) {
    const Token& word = stream.peek();
    if (word.kind != TokenKind::name) return {};
    if (is_lsys_keyword(word.text) || stream.peek(1).is("->"))
        return "write the statements of an L-system in a block: lsys NAME { ... }";
    if (std::string hint = foreign_word_hint(foreign, word.text); !hint.empty()) return hint;
    if (stream.peek(1).is("{")) return fmt::format("begin a block with its kind: lsys {} {{", word.text);
    if (stream.peek(1).is("=")) return fmt::format("'let {} = ...' names a number", word.text);
    std::vector<std::string> words(lsys_file_keywords.begin(), lsys_file_keywords.end());
    words.insert(words.end(), scene_keywords().begin(), scene_keywords().end());
    return choices(word.text, words);
}

/// A run of lines that are no statements here is reported once.
void skip_unknown(TokenStream& stream, const ForeignWords& foreign, bool report) {
    if (report)
        stream.expected("'lsys', 'use' or a scene statement").with_hint(hint_outside(stream, foreign));
    do {
        if (stream.next().is("{")) stream.skip_block();
    } while (!stream.at_end() && !stream.peek().first_on_line);
}

/// Parses the statements around the blocks. `lost_braces`: number of '}' whose '{' was not understood.
void parse_outside(TokenStream stream, const ForeignWords& foreign, LsysFile& file, std::size_t lost_braces) {
    stream.set_words(lsys_file_keywords, {});
    stream.drop_semicolons();
    bool lost = false;
    while (!stream.at_end() && !stream.diagnostics().full()) {
        const bool known = at_scene_statement(stream) || stream.at("use");
        if (stream.at("}") && lost_braces > 0) {
            --lost_braces;
            stream.next();
        } else if (!known) {
            skip_unknown(stream, foreign, !lost);
        } else if (stream.at("use")) {
            if (const auto use = parse_use(stream))
                file.uses.push_back(*use);
            else
                stream.skip_line();
        } else {
            parse_scene_statement(stream, file.statements);
        }
        lost = !known;
    }
}

} // namespace

const LsysBlock* main_block(const LsysFile& tree) {
    if (tree.blocks.empty()) return nullptr;
    const auto main = std::ranges::find_if(tree.blocks, &LsysBlock::is_main);
    return main == tree.blocks.end() ? &tree.blocks.back() : &*main;
}

LsysFile parse_lsys(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                    const ForeignWords& foreign) {
    LsysFile tree;
    tree.file = file;
    const LsysScanner scanner(sources, file, diagnostics);
    LsysText text{sources, scanner, diagnostics, {}};
    std::size_t at = 0;
    while (!diagnostics.full()) {
        const std::optional<LsysHeader> header = scanner.find_block(at);
        const std::size_t end = header ? header->begin : scanner.text().size();
        std::vector<Token> tokens = lex_range(sources, scanner.span(at, end), diagnostics);
        parse_outside({std::move(tokens), diagnostics, header ? "'lsys'" : "the end of the file"}, foreign,
                      tree, text.lost_braces);
        if (!header) break;
        at = parse_lsys_block(*header, text, tree);
    }
    return tree;
}

} // namespace graftal
