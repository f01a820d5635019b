#include "compiler/support/source.h"

#include <algorithm>

#include "compiler/support/check.h"

namespace graftal {

namespace {

bool continues_code_point(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

} // namespace

Span join(Span a, Span b) {
    if (!a.known()) return b;
    if (!b.known()) return a;
    GRAFTAL_CHECK(a.file == b.file, "join of spans");
    return {a.file, std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

FileId SourceMap::add(std::string name, std::string text, std::optional<FileId> original,
                      std::vector<Span> origins) {
    GRAFTAL_CHECK(text.size() < UINT32_MAX, "source text too long");
    File file{std::move(name), std::move(text), {0}, original, std::move(origins)};
    // Lines that end with carriage returns alone, as on computers long ago, would be one line.
    if (file.text.find('\n') == std::string::npos)
        std::replace(file.text.begin(), file.text.end(), '\r', '\n');
    for (std::size_t i = 0; i < file.text.size(); ++i)
        if (file.text[i] == '\n') file.line_begins.push_back(static_cast<std::uint32_t>(i + 1));
    files_.push_back(std::make_shared<const File>(std::move(file)));
    return static_cast<FileId>(files_.size() - 1);
}

FileId SourceMap::add(std::string name, std::string text) {
    return add(std::move(name), std::move(text), std::nullopt, {});
}

FileId SourceMap::add_translation(std::string name, std::string text, FileId original,
                                  std::vector<Span> origins) {
    return add(std::move(name), std::move(text), original, std::move(origins));
}

Span SourceMap::origin(Span span) const {
    if (!span.known()) return {};
    const std::vector<Span>& origins = files_[span.file]->origins;
    const std::size_t line = position(span.file, span.begin).line - 1;
    return line < origins.size() ? origins[line] : Span();
}

std::string_view SourceMap::text(Span span) const {
    if (!span.known()) return {};
    return text(span.file).substr(span.begin, span.end - span.begin);
}

Position SourceMap::position(FileId file, std::uint32_t offset) const {
    const File& source = *files_[file];
    offset = std::min(offset, static_cast<std::uint32_t>(source.text.size()));
    const auto after = std::upper_bound(source.line_begins.begin(), source.line_begins.end(), offset);
    const auto line = static_cast<std::uint32_t>(after - source.line_begins.begin());
    const auto first = source.text.begin() + source.line_begins[line - 1];
    const auto code_points =
        std::count_if(first, source.text.begin() + offset, [](char c) { return !continues_code_point(c); });
    return {line, static_cast<std::uint32_t>(code_points + 1)};
}

std::string_view SourceMap::line(FileId file, std::uint32_t line) const {
    const File& source = *files_[file];
    const std::uint32_t begin = source.line_begins[line - 1];
    const std::string_view rest = std::string_view(source.text).substr(begin);
    std::string_view text = rest.substr(0, rest.find('\n'));
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
}

} // namespace graftal
