#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace graftal {

/// Commands that read no model and print what the program knows of itself: `help`, `version`, `completion`,
/// `manual`.
class Documents {
  public:
    explicit Documents(CLI::App& app);

    /// The names of these commands.
    static std::vector<std::string> commands();

    /// The text that the command line asks for, after it was parsed; nothing if it asks for none. A usage
    /// error (CLI::Error) where it names a command that there is not.
    std::optional<std::string> text() const;

  private:
    CLI::App& app_;
    std::vector<std::string> command_; ///< of `help` and `manual`: the words of a command
    std::string shell_;
    bool json_ = false;
};

} // namespace graftal
