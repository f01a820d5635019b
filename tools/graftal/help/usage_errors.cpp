#include "tools/graftal/help/usage_errors.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "compiler/support/alternatives.h"
#include "compiler/support/diagnostics.h"
#include "tools/graftal/help/format.h"

namespace graftal {

namespace {

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options())
        for (const std::string& name : option->get_lnames())
            if (!is_for_tests(*option)) names.push_back("--" + name);
    return names;
}

/// "--size WxH"
std::string option_text(const CLI::Option& option) {
    const std::string value = option.get_type_name();
    return option.get_name() + (value.empty() ? "" : " " + value);
}

/// `MODEL`, or `A B`.
std::string operands_text(const CLI::App& command) {
    std::string text;
    for (const CLI::Option* const option : command.get_options())
        if (option->get_positional()) text += (text.empty() ? "" : " ") + option->get_name();
    return text;
}

/// The option that a message of CLI11 is about: it begins with the name. Null if it is about something else.
const CLI::Option* option_in(const std::string& message, const CLI::App& command) {
    const std::string name = message.substr(0, message.find_first_of(": "));
    for (const CLI::Option* const option : command.get_options())
        if (!option->get_positional() && option->get_name() == name) return option;
    return nullptr;
}

/// Whether the word gives a width or a height as other programs have them: --width, -w, +W640.
bool gives_side(const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    if (name == "--width" || name == "--height") return true;
    return name.size() > 1 && (name[0] == '+' || name[0] == '-') &&
           std::string_view("wWhH").find(name[1]) != std::string_view::npos &&
           name.find_first_not_of("0123456789", 2) == std::string::npos;
}

std::string unknown_option(const std::string& word, const CLI::App& command) {
    const std::string name = word.substr(0, word.find('='));
    const std::string hint = gives_side(word) && command.get_option_no_throw("--size")
                                 ? "width and height are one option, such as '--size 640x480'"
                                 : did_you_mean(name, option_names(command));
    return fmt::format("'{}' has no option '{}'{}", command.get_name(), name,
                       hint.empty() ? "" : fmt::format(" ({})", hint));
}

std::string extra_words(const CLI::App& command) {
    const std::vector<std::string> words = command.remaining(true);
    const auto option = std::find_if(words.begin(), words.end(), [](const std::string& word) {
        return word.size() > 1 && (word.front() == '-' || gives_side(word));
    });
    if (option != words.end()) return unknown_option(*option, command);
    const std::string word = words.empty() ? "" : words.front();
    return fmt::format("'{}' is one word too many: '{}' takes {}; put a name with spaces in quotes", word,
                       command.get_name(), operands_text(command));
}

} // namespace

std::string unknown_command(const std::string& word, const std::vector<std::string>& commands) {
    return fmt::format("there is no command '{}' ({})", word, choices(word, commands));
}

std::string unknown_word(const std::string& option, const std::string& word,
                         const std::vector<std::string>& words) {
    const std::string list = alternatives(words, [](const std::string& name) { return name; });
    const std::string hint = did_you_mean(word, words);
    return fmt::format("{}: '{}' is not {}{}", option, word, list,
                       hint.empty() ? "" : fmt::format(" ({})", hint));
}

std::string wrong_command(int argc, const char* const* argv, const std::vector<std::string>& commands) {
    if (argc < 2) return "no command given: try 'graftal render MODEL'";
    const std::string word = argv[1];
    const bool known = std::find(commands.begin(), commands.end(), word) != commands.end();
    if (word.empty() || word.front() == '-' || known) return {};
    if (word.find_first_of("./") != std::string::npos)
        return fmt::format("name a command first, such as 'graftal render {}'", word);
    return unknown_command(word, commands);
}

std::string usage_message(const CLI::ParseError& error, const CLI::App& command) {
    const std::string message = error.what();
    if (dynamic_cast<const CLI::ValidationError*>(&error)) return message; // said by ourselves
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) return extra_words(command);
    const CLI::Option* const option = option_in(message, command);
    const std::string other = message.substr(message.rfind(' ') + 1);
    if (dynamic_cast<const CLI::RequiresError*>(&error) && option)
        return fmt::format("{} needs {}: give both, or neither", option->get_name(), other);
    if (dynamic_cast<const CLI::ExcludesError*>(&error) && option) {
        return fmt::format("{} and {} exclude each other: give only one of them", option->get_name(), other);
    }
    if (option) return fmt::format("{} needs a value: {}", option->get_name(), option_text(*option));
    const std::string operands = operands_text(command);
    if (operands == "A B") return "'compare' takes two pictures: 'graftal compare A B'";
    if (operands.starts_with("JOB"))
        return fmt::format("no {} given: try 'graftal farm {} {}'",
                           message.find("TASKS") != std::string::npos ? "tasks" : "job", command.get_name(),
                           operands);
    if (operands.find("MODEL") == std::string::npos)
        return fmt::format("'{0}' needs {1}: 'graftal {0} {1}'", command.get_name(), operands);
    return fmt::format("no model given: try 'graftal {} {}'", command.get_name(), operands);
}

} // namespace graftal
