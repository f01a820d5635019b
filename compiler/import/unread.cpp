#include "compiler/import/unread.h"

#include <algorithm>

#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

constexpr std::string_view as_cpfg =
    "graftal reads L-systems of cpfg: lines 'Lsystem: 1', 'derivation length: 4', 'Axiom: A(1)', "
    "'A(x) --> F(x) A(x)' and 'endlsystem'";
constexpr std::string_view no_program =
    "graftal runs no programs: write its rules alone, as .lsys, .rifs or .inst";

bool has_import(std::string_view line) {
    return line.starts_with("import ") ||
           (line.starts_with("from ") && line.find(" import ") != std::string_view::npos) ||
           (line.starts_with("def ") && line.ends_with(':'));
}

std::optional<UnreadKind> kind_of_lines(std::string_view text, bool known_to_none) {
    std::optional<UnreadKind> found;
    std::optional<std::size_t> declaration, ended; // of a module; one that a ';' ends, as in C++
    std::optional<std::size_t> header;             // the first that is included
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text);
        if (words.empty()) continue;
        const auto has = [&](std::string_view word) { return words.find(word) != std::string_view::npos; };
        const std::size_t begin = line.begin + static_cast<std::size_t>(words.data() - line.text.data());
        const bool includes = words.starts_with("#include");
        if (includes && has("lpfgall"))
            return UnreadKind{"an L+C program for lpfg, which is C++", as_cpfg, begin};
        if (words.starts_with("module ")) {
            if (!declaration) declaration = begin;
            if (!ended && has(";")) ended = begin;
        }
        if (includes && !header) header = begin;
        if (header && words.starts_with("produce ") && words.ends_with(';')) ended = ended.value_or(*header);
        if (ended && has("produce ")) return UnreadKind{"an L+C program, which is C++", as_cpfg, *ended};
        if (declaration && has("==>")) return UnreadKind{"an XL program for GroIMP", as_cpfg, *declaration};
        if (!known_to_none || found) continue;
        if (words.starts_with("#declare ") || (includes && has(".inc\"")))
            found = {"a scene of POV-Ray", "graftal writes such scenes, by 'graftal compile'", begin};
        else if (includes)
            found = {"a C or C++ program", no_program, begin};
        else if (has_import(words))
            found = {"a Python program", no_program, begin};
    }
    return found;
}

} // namespace

std::optional<UnreadKind> unread_kind(std::string_view text, bool known_to_none) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t\n\f\v"), text.size());
    const std::string_view rest = text.substr(begin);
    if (known_to_none && rest.starts_with('<')) return UnreadKind{"XML or HTML", "", begin};
    if (known_to_none && (rest.starts_with('{') || rest.starts_with('['))) {
        const std::size_t next = rest.find_first_not_of(" \t\n", 1);
        if (next != std::string_view::npos &&
            std::string_view("\"{[").find(rest[next]) != std::string_view::npos)
            return UnreadKind{"JSON", "", begin};
    }
    return kind_of_lines(text, known_to_none);
}

} // namespace graftal
