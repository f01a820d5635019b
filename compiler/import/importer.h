#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// Prices of an importer's work, in the unit of support/stage_price.h.
struct ImportPrice {
    static constexpr double byte = 1.5e-7;     ///< of a file that is read and translated
    static constexpr double evaluation = 1e-7; ///< of an expression of a grammar that is computed
    static constexpr double unfolded = 1e-6;   ///< a shape of such a grammar, or a turn of its loops
};

/// A file of another program, and what its importer may ask for.
struct ForeignFile {
    FileId file = 0;
    const SourceMap& sources;
    Diagnostics& diagnostics;
    /// The text of a file that this one names, looked up beside it; nothing, without an error, if there is
    /// none. Texts stay valid.
    std::function<std::optional<FileId>(std::string_view name)> read_beside;
    WorkMeter* meter = nullptr; ///< counts the work; null: nobody does
    std::uint64_t seed = 0;     ///< of random numbers that the translation draws

    /// Throws OutOfWork where the command allows no more. `price`: of a unit (ImportPrice).
    void work(std::uint64_t units, double price) const {
        if (meter) meter->add(units, price);
    }
    std::string_view text() const { return sources.text(file); }
    Span span(std::size_t begin, std::size_t end) const {
        return {file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    }
};

/// A model in a foreign file.
struct ForeignModel {
    std::string name;
    Span span; ///< of its text
};

/// A model as text of one of our languages.
struct Translation {
    std::string_view extension; ///< of the language: "lsys"
    std::string text;
    std::vector<Span> origins; ///< of each line of the text; unknown where the importer wrote it by itself

    /// Adds a line, which may be empty. A line end in it becomes a blank: no name and no remark of a foreign
    /// file can begin a line of its own.
    void line(std::string_view words, Span origin = {}) {
        for (const char c : words)
            text += c == '\n' || c == '\r' ? ' ' : c;
        text += '\n';
        origins.push_back(origin);
    }
    void append(const Translation& lines) {
        text += lines.text;
        origins.insert(origins.end(), lines.origins.begin(), lines.origins.end());
    }
};

/// One format: a row of the table in importers.cpp. An importer drops nothing silently: what it cannot
/// translate is an error at its place, and what does not change the picture is at least a warning.
struct Importer {
    std::string_view format;                   ///< its name for people: "Fractint L-system"
    std::span<const std::string_view> endings; ///< of file names, in small letters, without the dot
    /// Whether a text is most likely of this format, and of no other; in a time linear in the text.
    bool (*recognises)(std::string_view text);
    std::string_view sign; ///< by which people know a text of the format: "a block 'name { ... }'"
    /// The models in the order of the text. Reports faults that keep it from telling them apart.
    std::vector<ForeignModel> (*models)(const ForeignFile& file);
    /// The translation of a model, which is of no use after an error.
    std::optional<Translation> (*translation)(const ForeignFile& file, const ForeignModel& model);
    std::string_view host = {}; ///< the kind of text (UnreadKind) that the format is a part of: "XML or HTML"
    std::size_t most_bytes = SIZE_MAX; ///< of a file

    /// The model as text of ours; nothing after an error.
    std::optional<Translation> translate(const ForeignFile& file, const ForeignModel& model) const;
};

} // namespace graftal
