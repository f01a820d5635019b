#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

namespace graftal {

/// The text for a comment or a file name: letters, digits and `_ . ( ) + -` stay, everything else becomes
/// `_`; at most 60 bytes. Text of a model can so never become SDL, nor leave its folder.
std::string harmless(std::string_view text);

/// The text as part of an SDL identifier: letters, digits and underscores, at most 24.
std::string identifier_part(std::string_view text);

/// The identifier of a whole model, by the name of its file without the ending: begins with a capital, so
/// that it is none of POV-Ray's words.
std::string model_identifier(std::string_view name);

/// Whether `--name` may be this: letters, digits and '_', a capital first, since POV-Ray's own words have
/// none; at most 24.
bool is_model_identifier(std::string_view text);

/// Hands out identifiers that begin with a prefix and differ from each other.
class UniqueNames {
  public:
    /// Requires a prefix with a capital letter (POV-Ray's words have none).
    explicit UniqueNames(std::string prefix) : prefix_(std::move(prefix)) {}

    std::string next(std::string_view wish);

  private:
    std::string prefix_;
    std::unordered_map<std::string, unsigned> used_; ///< name -> highest number tried with it
};

} // namespace graftal
