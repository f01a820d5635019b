#include "compiler/import/importers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/languages/languages.h"
#include "compiler/support/alternatives.h"
#include "compiler/support/path_text.h"
#include "compiler/support/small_letters.h"
#include "compiler/support/text_encoding.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

namespace {

std::string ending_of(std::string_view file_name) {
    const std::string ending = in_small_letters(extension_of(file_name));
    return ending.empty() ? ending : ending.substr(1);
}

/// Endings that promise no format: any may stand there.
constexpr std::array<std::string_view, 2> open_endings = {"lsystem", "txt"};

bool has_ending(const Importer& importer, std::string_view ending) {
    return std::ranges::find(importer.endings, ending) != importer.endings.end();
}

/// The error that a file is of none of these formats: at its first words, with what each format has.
void refuse(const ForeignFile& file, const std::vector<const Importer*>& rows) {
    const std::string_view name = file.sources.name(file.file), text = file.text();
    const std::string formats = alternatives(rows, [](const Importer* row) { return row->format; });
    std::string signs;
    for (const Importer* const row : rows)
        signs += fmt::format("{}{}: {}", signs.empty() ? "" : "; ", row->format, row->sign);
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
        file.diagnostics.error(Span(),
                               fmt::format("'{}' is no {}: its line {} has a byte 0, as no text has", name,
                                           formats, file.sources.position(file.file, nul).line));
        return;
    }
    const std::size_t first = text.find_first_not_of(" \t\n\f\v");
    if (first == std::string_view::npos) {
        file.diagnostics.error(Span(), fmt::format("'{}' is no {}: it is empty", name, formats));
        return;
    }
    const std::size_t end = std::min({text.find('\n', first), first + 80, text.size()});
    file.diagnostics
        .error(file.span(first, end), fmt::format("'{}' is no {}: these words begin none", name, formats))
        .with_hint(signs);
}

/// A kind of text that graftal knows, and does not read.
struct UnreadKind {
    std::string_view name;    ///< "a Python program"
    std::string_view instead; ///< the nearest thing that graftal reads; "" for none
    std::size_t begin = 0;    ///< of the words that tell it
};

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

/// The kind of a text, in a time linear in it. A language of programs with L-systems in them is known for
/// sure, although their blocks may look like another format's; `known_to_none`: other kinds are meant, too.
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

/// Whether the text is of a kind that no importer reads, after the error that says so. The reader of a format
/// that is a part of that kind knows better what does not fit. `promised`: by the file's name.
bool is_unread(const ForeignFile& file, bool known_to_none, const std::vector<const Importer*>& promised) {
    const std::string_view text = file.text();
    const std::optional<UnreadKind> kind = unread_kind(text, known_to_none);
    if (!kind || (promised.size() == 1 && promised.front()->host == kind->name)) return false;
    const std::size_t end = std::min({text.find('\n', kind->begin), kind->begin + 80, text.size()});
    file.diagnostics
        .error(file.span(kind->begin, end), fmt::format("'{}' is {}, and graftal does not read that",
                                                        file.sources.name(file.file), kind->name))
        .with_hint(std::string(kind->instead));
    return true;
}

std::vector<std::string> names_of(const std::vector<ForeignModel>& models) {
    std::vector<std::string> names;
    for (const ForeignModel& model : models)
        names.push_back(model.name);
    return names;
}

/// Whether the first word begins a statement in one of our languages, or nearly one of their own.
bool begins_as_ours(FileId file, const SourceMap& sources) {
    const std::vector<Token> tokens = lex_beginning(sources, file);
    if (tokens[0].kind == TokenKind::end) return true; // a comment, as far as one sees
    const auto has_first = [&](const auto& words) {
        return std::ranges::find(words, tokens[0].text) != std::end(words);
    };
    return has_first(scene_keywords()) || std::ranges::any_of(languages(), [&](const Language& ours) {
               return has_first(ours.keywords) || has_first(ours.inner_keywords) ||
                      !closest_name(tokens[0].text, {ours.keywords.begin(), ours.keywords.end()}).empty();
           });
}

/// Whether a text whose file has another name is foreign, as an error then says.
bool is_misnamed(FileId file, const SourceMap& sources, Diagnostics& diagnostics) {
    const std::string_view text = sources.text(file);
    if (is_binary(text) || begins_as_ours(file, sources)) return false;
    const auto row =
        std::ranges::find_if(importers(), [&](const Importer& known) { return known.recognises(text); });
    if (row == importers().end()) return false;
    diagnostics
        .error(Span(),
               fmt::format("'{}' is no model of graftal: it looks like {}", sources.name(file), row->format))
        .with_hint(fmt::format("name the file with the ending .{}, and graftal reads it",
                               row->endings.empty() ? open_endings.back() : row->endings.front()));
    return true;
}

} // namespace

std::span<const Importer> importers() {
    // Where two rows share an ending, the first that recognises the text has it.
    static const Importer table[] = {cpfg_importer(),         fractint_lsystem_importer(),
                                     lparser_importer(),      lpy_importer(),
                                     houdini_importer(),      bourke_importer(),
                                     vlab_surface_importer(), fractint_ifs_importer(),
                                     eisenscript_importer(),  cfdg_importer(),
                                     flame_importer()};
    return table;
}

Translator importing_translator() {
    return {.model_path = model_path, .model_text = model_text, .own_text = own_text};
}

bool is_foreign(std::string_view file_name) {
    const std::string ending = ending_of(file_name);
    return std::ranges::any_of(importers(), [&](const Importer& row) { return has_ending(row, ending); }) ||
           std::ranges::find(open_endings, ending) != open_endings.end();
}

std::string model_text(std::string_view file_name, std::string bytes) {
    return decoded_text(std::move(bytes),
                        is_foreign(file_name) ? OtherBytes::windows_1252 : OtherBytes::kept);
}

ModelPath model_path(std::string_view path) {
    for (std::size_t colon = path.find(':'); colon != std::string_view::npos;
         colon = path.find(':', colon + 1))
        if (is_foreign(path.substr(0, colon)))
            return {std::string(path.substr(0, colon)), std::string(path.substr(colon + 1))};
    return {std::string(path), {}};
}

std::string model_stem(std::string_view path) {
    const ModelPath parts = model_path(path);
    return parts.model.empty() ? std::string(stem_of(parts.file)) : plain_name(parts.model);
}

ForeignFile foreign_file(FileId file, SourceMap& sources, Diagnostics& diagnostics, TranslateOptions options,
                         WorkMeter* meter) {
    const std::uint64_t seed = options.seed;
    const auto read_beside = [&sources, file,
                              options = std::move(options)](std::string_view name) -> std::optional<FileId> {
        const std::string path = path_beside(sources.name(file), name);
        if (!options.root.empty() && !options.files->lies_in(path, options.root)) return std::nullopt;
        std::string text;
        if (!options.files->check(path).ok() || !options.files->read(path, text).ok()) return std::nullopt;
        return sources.add(path, decoded_text(std::move(text), OtherBytes::windows_1252));
    };
    const ForeignFile foreign{file, sources, diagnostics, read_beside, meter, seed};
    foreign.work(foreign.text().size(), ImportPrice::byte);
    return foreign;
}

const Importer* importer_of(const ForeignFile& file) {
    const std::string ending = ending_of(file.sources.name(file.file));
    std::vector<const Importer*> promised, others;
    for (const Importer& importer : importers())
        (has_ending(importer, ending) ? promised : others).push_back(&importer);
    const bool is_text = !is_binary(file.text());
    if (is_text && is_unread(file, false, promised)) return nullptr;
    const auto knows = [&](const Importer* row) { return is_text && row->recognises(file.text()); };
    if (const auto found = std::ranges::find_if(promised, knows); found != promised.end()) return *found;
    if (const auto found = std::ranges::find_if(others, knows); found != others.end()) {
        if (!promised.empty())
            file.diagnostics.note(Span(), fmt::format("'{}' is read as {}: its content is not {}",
                                                      file.sources.name(file.file), (*found)->format,
                                                      promised.front()->format));
        return *found;
    }
    if (is_text && is_unread(file, true, promised)) return nullptr;
    if (promised.size() == 1 && is_text) return promised.front(); // its reader says what does not fit
    refuse(file, promised.empty() ? others : promised);
    return nullptr;
}

std::optional<ForeignModel> find_model(const Importer& importer, const ForeignFile& file,
                                       std::string_view name) {
    const std::size_t errors = file.diagnostics.error_count();
    const std::vector<ForeignModel> models = importer.models(file);
    if (models.empty()) {
        if (file.diagnostics.error_count() == errors) refuse(file, {&importer});
        return std::nullopt;
    }
    if (name.empty() && models.size() == 1) return models.front();
    const auto named = [&](const auto& same) {
        return std::ranges::find_if(models, [&](const ForeignModel& model) { return same(model.name); });
    };
    auto found = named([&](std::string_view other) { return other == name; });
    const std::string small = in_small_letters(name);
    if (found == models.end())
        found = named([&](std::string_view other) { return in_small_letters(other) == small; });
    if (found != models.end()) return *found;
    const std::string_view file_name = file.sources.name(file.file);
    if (name.empty())
        file.diagnostics.error(Span(), fmt::format("'{}' holds {} models", file_name, models.size()))
            .with_hint(fmt::format("name one, as {0}:{1}; 'graftal import {0}' lists them", file_name,
                                   models.front().name));
    else
        file.diagnostics.error(Span(), fmt::format("'{}' holds no model '{}'", file_name, name))
            .with_hint(choices(name, names_of(models)));
    return std::nullopt;
}

std::optional<Translation> Importer::translate(const ForeignFile& file, const ForeignModel& model) const {
    if (file.text().size() > most_bytes) {
        file.diagnostics.error(file.span(0, 0),
                               fmt::format("{}: a file has at most {} characters", format, most_bytes));
        return std::nullopt;
    }
    const std::size_t errors = file.diagnostics.error_count();
    std::optional<Translation> written = translation(file, model);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return written;
}

std::optional<FileId> own_text(FileId file, std::string_view model, SourceMap& sources,
                               Diagnostics& diagnostics, const TranslateOptions& options, WorkMeter* meter) {
    if (!is_foreign(sources.name(file)))
        return is_misnamed(file, sources, diagnostics) ? std::nullopt : std::optional(file);
    const ForeignFile foreign = foreign_file(file, sources, diagnostics, options, meter);
    const Importer* const importer = importer_of(foreign);
    if (!importer) return std::nullopt;
    const std::optional<ForeignModel> found = find_model(*importer, foreign, model);
    if (!found) return std::nullopt;
    std::optional<Translation> translation = importer->translate(foreign, *found);
    if (!translation) return std::nullopt;
    const std::string name =
        fmt::format("{}:{}.{}", sources.name(file), plain_name(found->name), translation->extension);
    return sources.add_translation(name, std::move(translation->text), file, std::move(translation->origins));
}

} // namespace graftal
