#include <gmock/gmock.h>

#include "tests/golden/command_line.h"

namespace graftal {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;
using testing::UnorderedElementsAre;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) lines.push_back(line);
    return lines;
}

/// The commands of `graftal --help`.
class DocumentsTest : public CommandLine {
  protected:
    std::vector<std::string> commands() const {
        const std::string help = graftal("--help").out;
        std::vector<std::string> names;
        for (const std::string& line : lines_of(help.substr(help.find("Subcommands:"))))
            if (line.starts_with("  ")) names.push_back(line.substr(2, line.find(' ', 2) - 2));
        return names;
    }

    /// What a shell offers for the last word of a command line that is still being typed.
    std::vector<std::string> offers(const std::string& shell_name, const std::string& line) const {
        const RunResult result = shell(completion(shell_name, line));
        EXPECT_EQ(result.status, 0) << shell_name << ": " << result.err;
        std::vector<std::string> words = lines_of(result.out);
        for (std::string& word : words) {
            word.erase(std::min(word.size(), word.find('\t'))); // fish adds what the word means
            while (word.ends_with(' ') || word.ends_with('\r'))
                word.pop_back();
        }
        return words;
    }

    std::string completion(const std::string& shell_name, const std::string& line) const {
        const std::string program = std::string("'") + GRAFTAL_PROGRAM + "'";
        if (shell_name == "fish")
            return program +
                   " completion fish >graftal.fish && HOME=$PWD fish --no-config -c 'source graftal.fish; " +
                   "complete -C \"" + line +
                   "\"'; status=$?; rm -rf .config .local .cache graftal.fish; exit $status";
        if (shell_name == "bash")
            return program +
                   " completion bash >graftal.bash; bash -c 'source ./graftal.bash; rm graftal.bash; "
                   "line=$1; read -ra COMP_WORDS <<<\"$line\"; "
                   "[[ $line != *\" \" ]] || COMP_WORDS+=(\"\"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
                   "_graftal; printf \"%s\\n\" \"${COMPREPLY[@]}\"' - \"" +
                   line + "\"";
        return program + " completion zsh >_graftal && zsh -f '" + source_path("tests/golden/zsh_offers") +
               "' \"" + line + "\"; status=$?; rm -f _graftal; exit $status";
    }
};

constexpr const char* shells[] = {"bash", "fish", "zsh"};

TEST_F(DocumentsTest, HelpOfACommandIsItsOwnHelp) {
    EXPECT_EQ(graftal("help").out, graftal("--help").out);
    for (const std::string& command : commands())
        EXPECT_EQ(graftal("help " + command).out, graftal(command + " --help").out) << command;
    const RunResult unknown = graftal("help rendr");
    EXPECT_EQ(unknown.status, 2);
    EXPECT_THAT(unknown.err, HasSubstr("there is no command 'rendr' (did you mean 'render'?"));
}

TEST_F(DocumentsTest, ManyOptionsStandUnderHeadingsBehindTheExamples) {
    for (const std::string command : {"render", "animate", "points", "export", "compile"}) {
        const std::string help = graftal(command + " --help").out;
        const std::size_t examples = help.find("\nExample"), general = help.find("\nGeneral:"),
                          camera = help.find("\nCamera:"), experts = help.find("\nFor experts:");
        EXPECT_LT(examples, general) << command;
        EXPECT_LT(general, camera) << command;
        EXPECT_LT(camera, experts) << command;
        EXPECT_NE(experts, std::string::npos) << command;
        // No option has been forgotten: bash completes those that exist.
        EXPECT_EQ(help.find("\nOptions:"), std::string::npos) << help;
        for (const std::string& option : offers("bash", "graftal " + command + " --"))
            EXPECT_THAT(help, HasSubstr(option)) << command;
        const std::string page = graftal("manual " + command).out;
        EXPECT_THAT(page, HasSubstr(".SS Camera\n"));
    }
    EXPECT_EQ(graftal("compare --help").out.find("General:"), std::string::npos);
}

TEST_F(DocumentsTest, VersionIsTextOrJson) {
    EXPECT_EQ(graftal("version").out, graftal("--version").out);
    EXPECT_EQ(shell("'" GRAFTAL_PROGRAM
                    "' version --json | python3 -c 'import json, sys; d = json.load(sys.stdin); "
                    "print(d[\"name\"], d[\"version\"], *d[\"engines\"], *d[\"languages\"])'")
                  .out,
              graftal("version").out.substr(0, graftal("version").out.size() - 1) +
                  " native gpu povray lsys rifs inst\n");
}

TEST_F(DocumentsTest, EveryPageOfTheManualIsSetWithoutAWarning) {
    std::vector<std::string> pages = commands();
    pages.emplace_back("");
    for (const std::string& command : pages) {
        const RunResult page =
            shell("'" GRAFTAL_PROGRAM "' manual " + command + " | groff -man -Tutf8 -ww -P-cbou");
        EXPECT_EQ(page.err, "") << command;
        EXPECT_THAT(page.out, AllOf(HasSubstr("NAME"), HasSubstr("SYNOPSIS"), HasSubstr("EXIT STATUS")))
            << command;
        EXPECT_THAT(page.out, HasSubstr(command.empty() ? "graftal" : "graftal-" + command));
    }
    // Each option stands in the page with the sign that one types.
    const std::string render = shell("'" GRAFTAL_PROGRAM "' manual render | groff -man -Tascii -P-cbou").out;
    for (const char* option :
         {"--size WxH", "--engine auto|native|gpu|povray", "-o FILE, --output FILE", "--visible-only"})
        EXPECT_THAT(render, HasSubstr(option));
}

TEST_F(DocumentsTest, ThePageOfGraftalItselfLeadsToAPicture) {
    const RunResult set = shell("'" GRAFTAL_PROGRAM "' manual | groff -man -Tascii -P-cbou");
    for (const char* language : {".lsys", ".rifs", ".inst"})
        EXPECT_THAT(set.out, HasSubstr(language));
    const std::size_t model = set.out.find("       rifs crystal {"),
                      end = set.out.find("\n       }\n", model);
    ASSERT_NE(end, std::string::npos) << set.out;
    write("crystal.rifs", set.out.substr(model, end + 10 - model));
    ASSERT_THAT(set.out, HasSubstr("\n       graftal render crystal.rifs\n"));
    const RunResult drawn = graftal("render crystal.rifs -q --size 64x48");
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_TRUE(std::filesystem::exists(path("crystal.png")));
}

TEST_F(DocumentsTest, WhatIsIndentedInHelpStandsSoInTheManual) {
    const std::string page = shell("'" GRAFTAL_PROGRAM "' manual farm plan | groff -man -Tascii -P-cbou").out;
    EXPECT_THAT(page, HasSubstr("by all options of 'graftal render'; up to 131072 pixels a side;\n"));
}

TEST_F(DocumentsTest, AllShellsOfferTheCommands) {
    for (const char* const name : shells) {
        EXPECT_THAT(offers(name, "graftal "), IsSupersetOf(commands())) << name;
        EXPECT_THAT(offers(name, "graftal com"), UnorderedElementsAre("completion", "compare", "compile"))
            << name;
    }
}

TEST_F(DocumentsTest, AllShellsOfferOptionsAndTheirWords) {
    for (const char* const name : shells) {
        EXPECT_THAT(offers(name, "graftal render --eng"), Each(StartsWith("--engine"))) << name;
        EXPECT_THAT(offers(name, "graftal render --engine "),
                    UnorderedElementsAre("auto", "gpu", "native", "povray"))
            << name;
        EXPECT_THAT(offers(name, "graftal animate --ease s"), UnorderedElementsAre("smooth")) << name;
        EXPECT_THAT(offers(name, "graftal print --after merge"), UnorderedElementsAre("merge_equivalent"))
            << name;
    }
}

TEST_F(DocumentsTest, NothingNamesOptionsOfTests) {
    for (const std::string& command : commands())
        EXPECT_THAT(graftal("help " + command).out + graftal("manual " + command).out,
                    Not(HasSubstr("-test-")))
            << command;
    for (const std::string action : {"submit", "plan"})
        EXPECT_THAT(graftal("help farm " + action).out, Not(HasSubstr("-test-")));
    for (const char* const name : shells)
        EXPECT_THAT(graftal(std::string("completion ") + name).out, Not(HasSubstr("-test-"))) << name;
    EXPECT_THAT(graftal("render a.inst --test-linea").err, Not(HasSubstr("--test-linear")));
}

TEST_F(DocumentsTest, AllShellsOfferModelsAndFolders) {
    for (const char* const file : {"a fern.rifs", "tree.inst", "picture.png", "notes.txt"})
        write(file, "");
    std::filesystem::create_directory(path("models"));
    write("models/inner.lsys", "");
    for (const char* const name : shells) {
        const std::vector<std::string> models = offers(name, "graftal stats ");
        const std::string all = testing::PrintToString(models);
        EXPECT_THAT(all, AllOf(HasSubstr("fern.rifs"), HasSubstr("tree.inst"), HasSubstr("models"))) << name;
        EXPECT_THAT(all, Not(HasSubstr("notes.txt"))) << name;
        EXPECT_THAT(offers(name, "graftal stats tr"), UnorderedElementsAre("tree.inst")) << name;
        EXPECT_THAT(offers(name, "graftal stats models/in"), ElementsAre(EndsWith("inner.lsys"))) << name;
        EXPECT_THAT(testing::PrintToString(offers(name, "graftal render x.inst -o ")),
                    HasSubstr("picture.png"))
            << name;
        EXPECT_THAT(testing::PrintToString(offers(name, "graftal render --keep ")),
                    Not(HasSubstr("notes.txt")))
            << name;
    }
}

} // namespace
} // namespace graftal
