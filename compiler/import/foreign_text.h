#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"

namespace graftal {

/// A line of a text, without its end.
struct TextLine {
    std::size_t begin = 0; ///< offset in the text
    std::string_view text;
};

/// The lines from `begin` to `end`.
std::vector<TextLine> lines_of(std::string_view text, std::size_t begin, std::size_t end);

std::string_view trimmed(std::string_view text);

/// The text as one line of ASCII for a comment of ours. Old files have other letters in code pages that they
/// do not name.
std::string comment_text(std::string_view text);

/// The name of a module for a symbol of another program: the letter or digit itself; a word for what means
/// something else, or nothing, in our strings.
std::string symbol_name(char symbol);

/// A name of letters, digits and '_' for a block, a material or a file, that begins with a letter.
std::string plain_name(std::string_view name);
/// The plain name with a capital, for a block: primitives have small letters.
std::string block_name(std::string_view name);

/// The number that a text begins with, and how many characters it has with the blanks before it; none: no
/// number. Reads as strtod() does where the decimal point is a point, whatever the locale is.
struct LeadingNumber {
    double value = 0;
    std::size_t length = 0;
};
LeadingNumber leading_number(std::string_view text);

/// The linear light of an sRGB colour: "0.5, 0.2, 0".
std::string linear_text(const std::array<double, 3>& rgb);

/// A comment behind a line of ours; "" of none.
std::string remark_text(std::string_view comment);

/// The one model of a file, by the file's name, with its first line as the place.
std::vector<ForeignModel> one_model(const ForeignFile& file);

/// The models that begin at these places of a file, by the file's name; where they are several, with a
/// number.
std::vector<ForeignModel> models_at(const ForeignFile& file, const std::vector<std::size_t>& begins);

/// The one model of a file that is a scene: all of its text.
std::vector<ForeignModel> one_scene(const ForeignFile& file);

/// Reads the code of formats whose strings have a symbol for each byte: ASCII, and other letters as in
/// Latin-1. A typographic sign becomes the signs that it stands for, with a warning for each kind; any other
/// character is an error.
class CodeReader {
  public:
    /// `file` must outlive this.
    explicit CodeReader(const ForeignFile& file) : file_(file) {}

    /// The signs of the character at `at`, which moves past it; none after an error. The text begins at
    /// `begin` in the file, or all of it stands at `whole`. Requires at < text.size().
    std::string next(std::string_view text, std::size_t& at, std::size_t begin,
                     std::optional<std::uint32_t> whole = {});
    /// The signs of a whole text, whose faults are reported at `span`.
    std::string signs(std::string_view text, Span span);

  private:
    std::string signs_of(std::string_view character, Span span);

    const ForeignFile& file_;
    std::set<std::string, std::less<>> warned_; ///< characters
};

/// Whether a text has bytes that no text has: NUL. Pictures and programs have.
bool is_binary(std::string_view text);

} // namespace graftal
