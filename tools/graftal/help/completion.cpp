#include "tools/graftal/help/completion.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/languages/languages.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr std::array<std::string_view, 2> picture_extensions = {"png", "exr"};

/// "lsys|rifs|inst"
std::string extensions(ValueKind kind) {
    std::vector<std::string_view> names;
    if (kind == ValueKind::picture)
        names.assign(picture_extensions.begin(), picture_extensions.end());
    else
        for (const Language& language : languages())
            names.push_back(language.extension);
    return fmt::format("{}", fmt::join(names, "|"));
}

/// The words in single quotes, with what the shell writes for a quote.
std::string quoted(const std::string& text, std::string_view quote) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += quote;
        else if (c == '\\' && quote == "\\'")
            result += "\\\\"; // fish
        else
            result += c;
    }
    return result + "'";
}

std::string names_of(const std::vector<CommandTree>& commands) {
    std::string names;
    for (const CommandTree& command : commands)
        names += (names.empty() ? "" : " ") + command.path.back();
    return names;
}

/// The words of each command below the program, in quotes.
std::string quoted_paths(const CommandTree& tree, const char* separator) {
    std::string paths;
    for (const CommandTree* const command : all_commands(tree))
        if (command != &tree)
            paths += (paths.empty() ? "'" : separator + std::string("'")) + command->name(" ") + "'";
    return paths;
}

// ---------------------------------------------------------------------------------------------------- bash

/// The case of a value or an operand, as commands of the script.
std::string bash_offer(const OptionEntry& entry) {
    switch (entry.kind) {
    case ValueKind::model:
    case ValueKind::picture:
        return fmt::format("_graftal_files '{}'", extensions(entry.kind));
    case ValueKind::file:
        return "_graftal_files ''";
    case ValueKind::folder:
        return "_graftal_folders";
    case ValueKind::text:
        break;
    }
    return entry.words.empty() ? ":" : fmt::format("_graftal_words '{}'", fmt::join(entry.words, " "));
}

constexpr const char* bash_head =
    "# Completes the command lines of graftal in bash: source this file, or install it as graftal in\n"
    "# /usr/share/bash-completion/completions.\n"
    "\n"
    "_graftal_words() { # WORDS\n"
    "    mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$current\")\n"
    "}\n"
    "\n"
    "_graftal_folders() {\n"
    "    mapfile -t COMPREPLY < <(compgen -d -- \"$current\")\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "_graftal_files() { # EXTENSION|EXTENSION..., or '' for all\n"
    "    local name pattern=\"*.@($1)\" shopts=$(shopt -p extglob)\n"
    "    shopt -s extglob\n"
    "    COMPREPLY=()\n"
    "    while IFS= read -r name; do\n"
    "        [[ -z $1 || -d $name || $name == $pattern ]] && COMPREPLY+=(\"$name\")\n"
    "    done < <(compgen -f -- \"$current\")\n"
    "    $shopts\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "_graftal() {\n"
    "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command=graftal word\n"
    "    # bash splits --size=640x360 at the sign.\n"
    "    if [[ $current == = ]]; then\n"
    "        current=\n"
    "    elif [[ $previous == = ]]; then\n"
    "        previous=${COMP_WORDS[COMP_CWORD-2]}\n"
    "    fi\n"
    "    COMPREPLY=()\n"
    "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
    "        case \"$command $word\" in\n";

std::string bash_script(const CommandTree& tree) {
    std::string script = bash_head;
    const std::vector<const CommandTree*> all = all_commands(tree);
    script += fmt::format("        {}) command+=\" $word\" ;;\n        esac\n    done\n",
                          quoted_paths(tree, " | "));

    script += "    case \"$command $previous\" in\n";
    for (const CommandTree* const command : all) {
        for (const OptionEntry& option : command->options) {
            if (option.value.empty()) continue;
            std::vector<std::string> patterns;
            for (const std::string& name : option.names)
                patterns.push_back("'" + command->name(" ") + " " + name + "'");
            script += fmt::format("    {}) {}; return ;;\n", fmt::join(patterns, " | "), bash_offer(option));
        }
    }
    script += "    esac\n    case $command in\n";
    for (const CommandTree* const command : all) {
        std::vector<std::string> names;
        for (const OptionEntry& option : command->options)
            names.insert(names.end(), option.names.begin(), option.names.end());
        script +=
            fmt::format("    '{}')\n        if [[ $current == -* ]]; then\n            _graftal_words '{}'\n",
                        command->name(" "), fmt::join(names, " "));
        std::string offer;
        if (!command->commands.empty())
            offer = fmt::format("_graftal_words '{}'", names_of(command->commands));
        else if (!command->operands.empty())
            offer = bash_offer(command->operands.front());
        if (!offer.empty()) script += fmt::format("        else\n            {}\n", offer);
        script += "        fi\n        ;;\n";
    }
    return script + "    esac\n}\n\ncomplete -F _graftal graftal\n";
}

// ---------------------------------------------------------------------------------------------------- fish

std::string fish_quoted(const std::string& text) {
    return quoted(text, "\\'");
}

std::string fish_offer(const OptionEntry& entry) {
    switch (entry.kind) {
    case ValueKind::model:
    case ValueKind::picture:
        return fmt::format("-fa '(__graftal_files \"{}\")'", extensions(entry.kind));
    case ValueKind::file:
        return "-F";
    case ValueKind::folder:
        return "-fa '(__fish_complete_directories)'";
    case ValueKind::text:
        break;
    }
    return entry.words.empty() ? "-f" : fmt::format("-fa '{}'", fmt::join(entry.words, " "));
}

std::string fish_script(const CommandTree& tree) {
    std::string script = "# Completes the command lines of graftal in fish: install it as graftal.fish in\n"
                         "# /usr/share/fish/vendor_completions.d.\n\n"
                         "# Whether the words so far name this command and none below it.\n"
                         "function __graftal_at\n"
                         "    set -l command graftal\n"
                         "    for word in (commandline -opc)[2..]\n"
                         "        switch \"$command $word\"\n";
    const std::vector<const CommandTree*> all = all_commands(tree);
    script += fmt::format("            case {}\n                set command \"$command $word\"\n",
                          quoted_paths(tree, " "));
    script += "        end\n    end\n    test \"$command\" = \"$argv\"\nend\n\n"
              "function __graftal_files # EXTENSION|EXTENSION...\n"
              "    set -l start (commandline -ct)\n"
              "    for name in $start*\n"
              "        if test -d $name\n"
              "            echo $name/\n"
              "        else if string match -qr \"\\.($argv)\\$\" -- $name\n"
              "            echo $name\n"
              "        end\n"
              "    end\n"
              "end\n\ncomplete -c graftal -f\n";
    for (const CommandTree* const command : all) {
        const std::string start = fmt::format("complete -c graftal -n '__graftal_at {}'", command->name(" "));
        for (const CommandTree& below : command->commands)
            script += fmt::format("{} -a {} -d {}\n", start, below.path.back(),
                                  fish_quoted(in_one_line(below.summary)));
        for (const OptionEntry& operand : command->operands)
            script += fmt::format("{} {}\n", start, fish_offer(operand));
        for (const OptionEntry& option : command->options) {
            std::string names;
            for (const std::string& name : option.names)
                names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            script += fmt::format("{}{}{} -d {}\n", start, names,
                                  option.value.empty() ? "" : " -r " + fish_offer(option),
                                  fish_quoted(in_one_line(option.help)));
        }
    }
    return script;
}

// ----------------------------------------------------------------------------------------------------- zsh

/// Text inside of a specification of _arguments, which stands in single quotes.
std::string zsh_text(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
        escaped += c;
    }
    const std::string in_quotes = quoted(escaped, "'\\''");
    return in_quotes.substr(1, in_quotes.size() - 2);
}

std::string zsh_offer(const OptionEntry& entry) {
    const std::string message = ":" + zsh_text(entry.value) + ":";
    switch (entry.kind) {
    case ValueKind::model:
    case ValueKind::picture:
        return message + fmt::format("_files -g \"*.({})\"", extensions(entry.kind));
    case ValueKind::file:
        return message + "_files";
    case ValueKind::folder:
        return message + "_files -/";
    case ValueKind::text:
        break;
    }
    return entry.words.empty() ? message : fmt::format("{}({})", message, fmt::join(entry.words, " "));
}

std::string zsh_option(const OptionEntry& option) {
    const std::string rest =
        "[" + zsh_text(in_one_line(option.help)) + "]" + (option.value.empty() ? "" : zsh_offer(option));
    std::string lines;
    for (const std::string& name : option.names) {
        const std::string once = option.repeats ? "*" : fmt::format("({})", fmt::join(option.names, " "));
        const std::string with_value = option.value.empty()     ? name
                                       : name.starts_with("--") ? name + "="
                                                                : name + "+";
        lines += fmt::format(" \\\n        '{}{}{}'", once, with_value, rest);
    }
    return lines;
}

std::string zsh_function(const CommandTree& command) {
    std::string body = fmt::format("{}() {{\n", "_" + command.name("_"));
    std::string options;
    for (const OptionEntry& option : command.options)
        options += zsh_option(option);
    if (command.commands.empty()) {
        body += "    _arguments -s -S" + options;
        for (const OptionEntry& operand : command.operands)
            body += fmt::format(" \\\n        '{}{}'", operand.repeats ? "*" : "", zsh_offer(operand));
        return body + "\n}\n\n";
    }
    body += "    local context state line curcontext=$curcontext\n    _arguments -C" + options +
            " \\\n        '1: :->command' \\\n        '*:: :->words' && return\n    case $state in\n    "
            "command)\n"
            "        local -a commands=(";
    for (const CommandTree& below : command.commands)
        body += "\n            '" + below.path.back() + ":" + zsh_text(in_one_line(below.summary)) + "'";
    body += ")\n        _describe command commands\n        ;;\n    words)\n        case $words[1] in\n";
    for (const CommandTree& below : command.commands)
        body += fmt::format("        {}) {} ;;\n", below.path.back(), "_" + below.name("_"));
    return body + "        esac\n        ;;\n    esac\n}\n\n";
}

std::string zsh_script(const CommandTree& tree) {
    std::string script =
        "#compdef graftal\n"
        "# Completes the command lines of graftal in zsh: install it as _graftal in a folder of $fpath.\n\n";
    for (const CommandTree* const command : all_commands(tree))
        script += zsh_function(*command);
    return script + "if [[ $funcstack[1] == _graftal ]]; then\n    _graftal \"$@\"\nelse\n    compdef "
                    "_graftal graftal\nfi\n";
}

struct Shell {
    const char* name;
    std::string (*script)(const CommandTree&);
};

constexpr Shell shells[] = {{"bash", bash_script}, {"fish", fish_script}, {"zsh", zsh_script}};

} // namespace

std::vector<std::string> completed_shells() {
    std::vector<std::string> names;
    for (const Shell& shell : shells)
        names.emplace_back(shell.name);
    return names;
}

std::string completion_script(std::string_view shell, const CommandTree& tree) {
    const auto* const found = std::ranges::find(shells, shell, &Shell::name);
    GRAFTAL_CHECK(found != std::end(shells), "completion: a shell of the table");
    return found->script(tree);
}

} // namespace graftal
