#include "tools/graftal/help/manual.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace graftal {

namespace {

/// Text in which troff finds nothing of its own. Hyphens stay those of the command line, so that they can be
/// copied.
std::string text(const std::string& plain) {
    std::string escaped;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const bool begins_line = i == 0 || plain[i - 1] == '\n';
        if (begins_line && (plain[i] == '.' || plain[i] == '\'')) escaped += "\\&";
        if (plain[i] == '\\')
            escaped += "\\e";
        else if (plain[i] == '-')
            escaped += "\\-";
        else if (plain[i] == '\'')
            escaped += "\\(aq";
        else if (plain[i] == '^')
            escaped += "\\(ha";
        else if (plain[i] == '`')
            escaped += "\\(ga";
        else if (plain[i] == '~')
            escaped += "\\(ti";
        else
            escaped += plain[i];
    }
    return escaped;
}

std::string bold(const std::string& word) {
    return "\\fB" + text(word) + "\\fR";
}

std::string italic(const std::string& word) {
    return "\\fI" + text(word) + "\\fR";
}

/// Filled text, with indented lines as they stand.
std::string notes_of(const std::string& plain) {
    std::string body;
    bool as_it_stands = false;
    for (std::size_t at = 0; at < plain.size();) {
        const std::size_t end = std::min(plain.find('\n', at), plain.size());
        const std::string line = plain.substr(at, end - at);
        if (line.starts_with(' ') != as_it_stands) {
            as_it_stands = !as_it_stands;
            body += as_it_stands ? ".EX\n" : ".EE\n";
        }
        body += text(line) + "\n";
        at = end + 1;
    }
    return body + (as_it_stands ? ".EE\n" : "");
}

std::string section(const std::string& heading, const std::string& body) {
    return body.empty() ? "" : ".SH " + heading + "\n" + body;
}

std::string synopsis(const CommandTree& command) {
    std::string line = bold(command.name(" "));
    if (!command.commands.empty()) return line + " " + italic("COMMAND") + " [" + italic("OPTION") + "]...\n";
    line += " [" + italic("OPTION") + "]...";
    for (const OptionEntry& operand : command.operands)
        line += " " + italic(operand.value) +
                (operand.repeats && operand.value.find(' ') == std::string::npos ? "..." : "");
    return line + "\n";
}

std::string options(const CommandTree& command) {
    std::string body;
    for (const OptionEntry& operand : command.operands)
        body += fmt::format(".TP\n{}\n{}.\n", italic(operand.value), text(operand.help));
    std::vector<std::string> groups;
    for (const OptionEntry& option : command.options)
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    for (const std::string& group : groups) {
        if (groups.size() > 1) body += fmt::format(".SS {}\n", text(group));
        for (const OptionEntry& option : command.options) {
            if (option.group != group) continue;
            std::vector<std::string> names;
            for (const std::string& name : option.names)
                names.push_back(bold(name) + (option.value.empty() ? "" : " " + italic(option.value)));
            body += fmt::format(".TP\n{}\n{}.\n", fmt::join(names, ", "), text(option.help));
        }
    }
    return body;
}

std::string commands_of(const CommandTree& command) {
    std::string body;
    for (const CommandTree& below : command.commands)
        body += fmt::format(".TP\n{}(1)\n{}.\n", bold(below.name("-")), text(below.summary));
    return body;
}

std::string examples_of(const std::string& lines) {
    return lines.empty() ? "" : ".EX\n" + text(lines) + ".EE\n";
}

/// The other pages, without those that stand in the page already and those of commands below commands.
std::string see_also(const CommandTree& command, const CommandTree& whole) {
    std::vector<std::string> pages;
    if (&command != &whole) {
        pages.push_back(bold(whole.path.front()) + "(1)");
        for (const CommandTree& other : whole.commands)
            if (&other != &command) pages.push_back(bold(other.name("-")) + "(1)");
    }
    for (const char* const program : {"povray", "ffmpeg"})
        pages.push_back(bold(program) + "(1)");
    return fmt::format("{}\n", fmt::join(pages, ",\n"));
}

/// The description on the page of graftal itself, for people who read it first.
constexpr const char* description =
    "graftal turns small text files, called models, into pictures of enormous things: fractals, plants,\n"
    "forests. The end of a model's name tells the language that it is written in:\n"
    ".TP\n.B .lsys\nA parametric L\\-system, the rules by which a plant grows.\n"
    ".TP\n.B .rifs\nA recurrent iterated function system, a set made of smaller copies of itself.\n"
    ".TP\n.B .inst\nObjects made of instances of objects. An object may contain itself.\n"
    ".PP\n"
    "graftal compiles a model into a graph of objects and instances. It proves that every recursion\n"
    "shrinks, and stops where a pixel can show no more detail. Then it writes a scene for\n"
    ".BR povray (1),\n"
    "or traces the picture itself\n"
    ".RB ( \\-\\-engine\\ native ).\n"
    ".PP\n"
    "The tutorial, the languages and a gallery with its models are in the folders\n.I docs\nand\n.I scenes\n"
    "of graftal's sources. The Debian package graftal\\-doc installs them in\n"
    ".IR /usr/share/doc/graftal\\-doc .\n";
constexpr const char* first_picture = "Save this model as\n.IR crystal.rifs :\n"
                                      ".PP\n.EX\n"
                                      "rifs crystal {\n"
                                      "  map n { scale 1/2  translate <0,  1/2, 0> }\n"
                                      "  map s { scale 1/2  translate <0, \\-1/2, 0> }\n"
                                      "  map e { scale 1/2  translate < 1/2, 0, 0> }\n"
                                      "  map w { scale 1/2  translate <\\-1/2, 0, 0> }\n"
                                      "  map f { scale 1/2  translate <0, 0,  1/2> }\n"
                                      "  map b { scale 1/2  translate <0, 0, \\-1/2> }\n"
                                      "  terminal sphere\n"
                                      "}\n"
                                      ".EE\n.PP\nThis command draws it, as\n.IR crystal.png :\n"
                                      ".PP\n.EX\n"
                                      "graftal render crystal.rifs\n"
                                      ".EE\n";
constexpr const char* first_examples =
    "graftal check crystal.rifs                             # what is wrong with it\n"
    "graftal stats crystal.rifs --steps 12                  # exact counts, dimension, bounds\n"
    "graftal render crystal.rifs --watch                    # again after each save\n"
    "graftal render crystal.rifs --engine povray            # by POV-Ray\n"
    "graftal animate crystal.rifs                           # once around it: crystal.gif\n"
    "graftal help render                                    # the options of a command\n";

constexpr const char* exit_status = ".TP\n0\nSuccess.\n"
                                    ".TP\n1\nThe model or the result is at fault.\n"
                                    ".TP\n2\nThe command line is wrong.\n"
                                    ".TP\n3\nThe environment is at fault: files, memory, POV\\-Ray.\n"
                                    ".TP\n128 + \\fIn\\fR\nSignal \\fIn\\fR ended the command.\n";

} // namespace

std::string manual_page(const CommandTree& command, const CommandTree& whole) {
    const bool is_whole = &command == &whole;
    std::string summary = command.summary;
    for (char& c : summary)
        if (c == '\n') c = ' ';
    std::string page =
        fmt::format(".TH {} 1 \"\" \"graftal {}\" \"graftal\"\n", text(command.name("-")), GRAFTAL_VERSION);
    page +=
        section("NAME", fmt::format("{} \\- {}\n", text(command.name("-")),
                                    is_whole ? "pictures of fractals and plants, from models of a few lines"
                                             : text(summary)));
    page += section("SYNOPSIS", synopsis(command));
    page += section("DESCRIPTION",
                    is_whole ? description
                             : text(summary) + (summary.ends_with('.') ? "" : ".") + "\n" +
                                   (command.notes.empty() ? "" : ".PP\n" + notes_of(command.notes)));
    if (is_whole) page += section("A FIRST PICTURE", first_picture);
    page += section("COMMANDS", commands_of(command));
    page += section("OPTIONS", options(command));
    page += section("EXIT STATUS", exit_status);
    page += section("EXAMPLES", examples_of(is_whole ? first_examples : command.examples));
    page += section("SEE ALSO", see_also(command, whole));
    return page;
}

} // namespace graftal
