#include "tests/golden/command_line.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <sys/wait.h>

#include "runtime/image_files/image_files.h"

namespace graftal {

namespace {

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : " ") + name;
    return text;
}

} // namespace

void CommandLine::SetUp() {
    ASSERT_TRUE(directory_.create().ok());
    std::filesystem::create_directory(directory_.path() + "/here");
    std::filesystem::create_directory(directory_.path() + "/tmp");
}

RunResult CommandLine::shell(const std::string& command) const {
    const std::string& top = directory_.path();
    const std::string script = "cd '" + top + "/here' && export TMPDIR='" + top + "/tmp' graftal='" +
                               GRAFTAL_PROGRAM "' && { " + command + "\n} >'" + top + "/out' 2>'" + top +
                               "/err' </dev/null";
    const int wait_status = std::system(script.c_str());
    RunResult result;
    result.status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
    result.out = contents(top + "/out");
    result.err = contents(top + "/err");
    return result;
}

RunResult CommandLine::graftal(const std::string& arguments) const {
    return shell("\"$graftal\" " + arguments);
}

void CommandLine::write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
}

std::string CommandLine::read(const std::string& name) const {
    return contents(path(name));
}

bool CommandLine::exists(const std::string& name) const {
    return std::filesystem::exists(path(name));
}

std::string CommandLine::files() const {
    return names_in(directory_.path() + "/here");
}

std::string CommandLine::temporary_files() const {
    return names_in(directory_.path() + "/tmp");
}

std::string source_path(const std::string& name) {
    return std::string(GRAFTAL_SOURCE_DIR "/") + name;
}

Image CommandLine::picture(const std::string& name) const {
    Image image;
    const Status status = read_image(path(name), image);
    EXPECT_TRUE(status.ok()) << status.message();
    return image;
}

ImageDifference CommandLine::engines_differ(const std::string& words, double threshold) const {
    for (const std::string engine : {"native", "povray"}) {
        const RunResult run =
            graftal("render " + words + " -q --engine " + engine + " -o " + engine + ".png");
        EXPECT_EQ(run.status, 0) << run.err;
    }
    return compare_images(picture("native.png"), picture("povray.png"), threshold);
}

std::vector<std::string> CommandLine::commands_of(const std::string& page) const {
    const std::string text = contents(source_path(page));
    EXPECT_NE(text, "") << page;
    EXPECT_EQ(shell("ln -s '" + source_path("scenes") + "' scenes").status, 0);
    const std::string mark = "\n    graftal ";
    std::vector<std::string> commands;
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
        const std::size_t begin = at + mark.size();
        commands.push_back(text.substr(begin, text.find('\n', begin) - begin));
    }
    return commands;
}

} // namespace graftal
