#include "compiler/lower/lower.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/graph/verify.h"
#include "compiler/lower/check_graph.h"
#include "compiler/lower/lower_inst.h"
#include "compiler/lower/lower_lsys.h"
#include "compiler/lower/lower_rifs.h"
#include "compiler/lower/lowering.h"
#include "compiler/support/file.h"
#include "compiler/support/number.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/lsys_scanner.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

namespace {

constexpr std::string_view standard_input = "<stdin>";

/// The language of a text without a file name: by the first word outside of braces that only one language
/// begins a statement with.
std::string guessed_language(FileId file, const SourceMap& sources) {
    Diagnostics ignored; // the front-end reads the text again
    std::size_t depth = 0;
    for (const Token& token : lex(sources, file, ignored)) {
        if (token.is("{")) ++depth;
        if (token.is("}") && depth > 0) --depth;
        if (depth > 0 || !token.first_on_line) continue;
        if (token.is("main")) return "rifs"; // `main rifs NAME {`
        if (token.is("orbit")) return "rifs";
        if (token.is("rifs") || token.is("lsys")) return std::string(token.text);
        if (token.is("object") || token.is("canonical")) break;
    }
    return "inst";
}

/// The words that a text of a language begins with; those of the other languages are for the hint that it is
/// one.
std::vector<std::string> first_words(const std::string& language) {
    std::vector<std::string> words =
        language == "inst"   ? std::vector<std::string>{"object", "canonical", "use"}
        : language == "rifs" ? std::vector<std::string>{"rifs", "main", "orbit", "use"}
                             : std::vector<std::string>{"lsys", "main", "use"};
    words.insert(words.end(), scene_keywords().begin(), scene_keywords().end());
    return words;
}

/// Whether the first statement is one, or a misspelt one. Who names another file by mistake, or by the
/// mistake of a stranger's link, must not see it printed line by line as bad syntax.
bool looks_like_model(FileId file, const std::string& language, const SourceMap& sources) {
    constexpr std::size_t glimpse = 4096;
    Diagnostics ignored; // the front-end reads the text again
    const std::size_t size = sources.text(file).size();
    const Span beginning{file, 0, static_cast<std::uint32_t>(std::min(size, glimpse))};
    std::vector<Token> tokens = lex_range(sources, beginning, ignored);
    if (tokens.size() < 3 && size > glimpse) tokens = lex(sources, file, ignored);
    if (tokens.size() == 1) return true; // empty, as the front-end will say
    const Token& first = tokens[0];
    const Token& second = tokens[1];
    if (first.kind != TokenKind::name) return first.is("}") || first.is("{") || first.is(";");
    for (const std::string& known :
         {language, std::string("inst"), std::string("rifs"), std::string("lsys")}) {
        const std::vector<std::string> words = first_words(known);
        if (std::find(words.begin(), words.end(), first.text) != words.end()) return true;
        if (!closest_name(first.text, words).empty()) return true;
    }
    return second.is("{") || second.is("=") || second.is("->") || is_lsys_keyword(first.text) ||
           first.is("map") || first.is("codes");
}

std::optional<Graph> lower_root(FileId file, const LowerOptions& options, SourceMap& sources,
                                Diagnostics& diagnostics, std::optional<Derivation>* derivation) {
    Lowering lowering{.sources = sources, .diagnostics = diagnostics, .options = options};
    if (options.time && !options.steps && model_language(file, sources) != "lsys") {
        diagnostics
            .error(Span{file, 0, 0}, fmt::format("--steps {}: only L-systems have times between their steps",
                                                 shortest(*options.time)))
            .with_hint("give a whole number");
        return std::nullopt;
    }
    const std::filesystem::path path(sources.name(file));
    lowering.loading.push_back({path.lexically_normal().string(), Span()});
    std::optional<Graph> graph = lower_file(file, Span{file, 0, 0}, lowering);
    if (diagnostics.has_errors() || (graph && !check_graph(*graph, diagnostics))) return std::nullopt;
    if (graph) check_verified(*graph, "lower");
    if (derivation) *derivation = std::move(lowering.derivation);
    return graph;
}

} // namespace

std::string model_language(FileId file, const SourceMap& sources) {
    const std::string_view name = sources.name(file);
    if (name == standard_input) return guessed_language(file, sources);
    const std::string extension = std::filesystem::path(name).extension().string();
    return extension.empty() ? "" : extension.substr(1);
}

std::optional<Graph> lower_file(FileId file, Span asked_for, Lowering& lowering) {
    if (lowering.diagnostics.full()) { // front-ends stop there, so that none may begin
        ++lowering.known_failures;
        return std::nullopt;
    }
    const std::string_view name = lowering.sources.name(file);
    const std::string language = model_language(file, lowering.sources);
    // Without the text: of what is no model nothing is shown.
    const Span place = asked_for.file == file ? Span() : asked_for;
    const bool known = language == "inst" || language == "rifs" || language == "lsys";
    if (known && !looks_like_model(file, language, lowering.sources)) {
        lowering.diagnostics
            .error(place, fmt::format("'{}' is no model: its first word begins no statement", name))
            .with_hint(choices("", first_words(language)));
        return std::nullopt;
    }
    if (language == "inst") return lower_inst(file, lowering);
    if (language == "rifs") return lower_rifs(file, lowering);
    if (language == "lsys") return lower_lsys(file, lowering);
    lowering.diagnostics.error(place, fmt::format("'{}' is no model that is known here", name))
        .with_hint("the names of models end in .lsys, .rifs or .inst");
    return std::nullopt;
}

std::optional<Graph> lower_model(const std::string& path, const LowerOptions& options, SourceMap& sources,
                                 Diagnostics& diagnostics, Status& status,
                                 std::optional<Derivation>* derivation) {
    std::string text;
    if (path != "-" && !options.root.empty() && !lies_in(path, options.root)) {
        diagnostics.error(Span(), fmt::format("'{}' leads out of --root '{}'", path, options.root));
        return std::nullopt;
    }
    status = read_text(path, text);
    if (!status.ok()) return std::nullopt;
    return lower_text(path, std::move(text), options, sources, diagnostics, derivation);
}

std::optional<Graph> lower_text(const std::string& name, std::string text, const LowerOptions& options,
                                SourceMap& sources, Diagnostics& diagnostics,
                                std::optional<Derivation>* derivation) {
    const FileId file = sources.add(name == "-" ? std::string(standard_input) : name, std::move(text));
    return lower_root(file, options, sources, diagnostics, derivation);
}

} // namespace graftal
