#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graftal {

/// Index of a file in a SourceMap.
using FileId = std::uint32_t;

/// The half-open byte range [begin, end) of one source file; the default span points nowhere.
struct Span {
    static constexpr FileId no_file = UINT32_MAX;

    FileId file = no_file;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    bool known() const { return file != no_file; }
    bool operator==(const Span&) const = default;
};

/// The smallest span over both; requires that both lie in one file, or that one of them is unknown.
Span join(Span a, Span b);

/// A place as people count: lines and columns from 1, columns in code points (UTF-8), not bytes.
struct Position {
    std::uint32_t line = 1;
    std::uint32_t column = 1;
};

/// The texts that a compilation has read. A copy shares them: texts, and views of them, live as long as any
/// map that holds them.
class SourceMap {
  public:
    /// Adds a text under the name that diagnostics print. Requires text.size() < 2^32 - 1.
    FileId add(std::string name, std::string text);
    /// Adds a text that was made of another file of the map. `origins`: the place there that each of its
    /// lines comes from, where that is known. Requires as many `origins` as lines, or fewer.
    FileId add_translation(std::string name, std::string text, FileId original, std::vector<Span> origins);

    std::string_view name(FileId file) const { return files_[file]->name; }
    std::string_view text(FileId file) const { return files_[file]->text; }
    std::string_view text(Span span) const;
    std::size_t size() const { return files_.size(); }

    /// The file that this one was made of; nothing of a file that was read.
    std::optional<FileId> original(FileId file) const { return files_[file]->original; }
    /// Where the line of a place in a translation comes from; unknown elsewhere.
    Span origin(Span span) const;

    /// Where a byte lies; an offset past the end gives the place just after the last character.
    Position position(FileId file, std::uint32_t offset) const;

    /// The line (from 1) without its line end.
    std::string_view line(FileId file, std::uint32_t line) const;

  private:
    struct File {
        std::string name;
        std::string text;
        std::vector<std::uint32_t> line_begins;
        std::optional<FileId> original;
        std::vector<Span> origins; ///< of a translation, by lines
    };

    FileId add(std::string name, std::string text, std::optional<FileId> original, std::vector<Span> origins);

    std::vector<std::shared_ptr<const File>> files_;
};

} // namespace graftal
