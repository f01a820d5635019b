// Includes go only to the layers that CMakeLists.txt says a layer uses; and no layer ends its process.

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;
using Layers = std::map<std::string, std::set<std::string>>; // folder -> folders that it may include

const fs::path project = GRAFTAL_SOURCE_DIR;

/// The table of graftal_layer() calls. A layer stands below all that it uses, so one read is enough.
Layers layers_of_project() {
    static const std::regex call(R"(^graftal_layer\((\S+)\s*(?:USES ([a-z_/ ]+))?)");
    Layers layers;
    std::ifstream lists(project / "CMakeLists.txt");
    for (std::string line; std::getline(lists, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, call)) continue;
        const std::string folder = match[1];
        std::set<std::string>& allowed = layers[folder] = {folder};
        std::istringstream uses(match[2]);
        for (std::string used; uses >> used;) {
            EXPECT_TRUE(layers.count(used)) << folder << " uses " << used << ", which stands below it";
            allowed.merge(std::set(layers[used]));
        }
    }
    return layers;
}

/// The layer that a folder belongs to: itself, or the nearest one around it. "" outside of all layers.
std::string layer_of(fs::path folder, const Layers& layers) {
    while (!folder.empty() && !layers.count(folder.string()))
        folder = folder.parent_path();
    return folder.string();
}

/// Calls `visit(file, text)` for each source in the folders of a list, and in the folders within them.
template<typename Visit> void visit_sources(const std::vector<std::string>& folders, const Visit& visit) {
    for (const std::string& folder : folders)
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(project / folder)) {
            const fs::path file = entry.path().lexically_relative(project);
            if (!entry.is_regular_file() || (file.extension() != ".cpp" && file.extension() != ".h"))
                continue;
            std::ifstream text(entry.path());
            visit(file, std::string{std::istreambuf_iterator<char>(text), {}});
        }
}

/// Faults of a source in `folder`.
std::vector<std::string> faulty_includes(const fs::path& folder, const std::string& text,
                                         const Layers& layers) {
    const std::string layer = layer_of(folder, layers);
    if (layer.empty()) return {"it is in no layer of CMakeLists.txt"};
    constexpr std::string_view include = "#include \"";
    std::vector<std::string> faults;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(include)) continue;
        const fs::path included = line.substr(include.size(), line.rfind('"') - include.size());
        if (!layers.at(layer).count(layer_of(included.parent_path(), layers)))
            faults.push_back("it includes " + included.string());
    }
    return faults;
}

TEST(Layers, IncludesGoDownTheListOnly) {
    const Layers layers = layers_of_project();
    ASSERT_GT(layers.size(), 10u);
    int sources = 0;
    visit_sources({"compiler", "runtime"}, [&](const fs::path& file, const std::string& text) {
        ++sources;
        if (file.parent_path() == "runtime/python") return; // a program on top of all layers
        for (const std::string& fault : faulty_includes(file.parent_path(), text, layers))
            ADD_FAILURE() << file.string() << ": " << fault;
    });
    EXPECT_GT(sources, 500);
}

TEST(Layers, ARoomWithinALayerIsHeldToIt) {
    const Layers layers{{"compiler/low", {"compiler/low"}},
                        {"compiler/high", {"compiler/high", "compiler/low"}},
                        {"compiler/high/own", {"compiler/high/own"}}};
    const auto faults = [&](const char* folder, const std::string& included) {
        return faulty_includes(folder, "#pragma once\n#include \"" + included + "\"\n", layers).size();
    };
    EXPECT_EQ(faults("compiler/low", "compiler/high/a.h"), 1u);
    EXPECT_EQ(faults("compiler/low/room", "compiler/high/a.h"), 1u);
    EXPECT_EQ(faults("compiler/low/room/inner", "compiler/high/room/a.h"), 1u);
    EXPECT_EQ(faults("compiler/low/room", "compiler/low/a.h"), 0u);
    EXPECT_EQ(faults("compiler/high", "compiler/low/room/a.h"), 0u);
    EXPECT_EQ(faults("compiler/high/own/room", "compiler/low/a.h"), 1u) << "a layer within a layer";
    EXPECT_EQ(faults("compiler/high", "tests/a.h"), 1u);
    EXPECT_EQ(faults("compiler/nowhere", "compiler/low/a.h"), 1u);
}

/// A call by which a source would end or signal the process that it is part of; "" if there is none.
std::string end_of_process(const std::string& text) {
    for (const char* const call : {"abort(", "exit(", "_exit(", "quick_exit(", "raise(", "alarm(",
                                   "setitimer(", "kill(getpid(", "kill(::getpid("})
        for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1))
            if (at == 0 || (!std::isalnum(static_cast<unsigned char>(text[at - 1])) && text[at - 1] != '_'))
                return call;
    return {};
}

TEST(Layers, OnlyMainEndsItsProcess) {
    visit_sources({"compiler", "runtime"}, [&](const fs::path& file, const std::string& text) {
        if (file == "runtime/system/process.cpp") return; // ends the child that it has forked
        EXPECT_EQ(end_of_process(text), "") << file.string();
    });
    EXPECT_EQ(end_of_process("if (late) ::kill(::getpid(), SIGALRM);"), "kill(::getpid(");
    EXPECT_EQ(end_of_process("std::exit(3);"), "exit(");
    EXPECT_EQ(end_of_process("::kill(child, SIGTERM); turtle.frame_exit(2);"), "");
}

/// The first header of the operating system in a text; "" if there is none.
std::string system_header(const std::string& text) {
    static const std::regex include(
        R"(#include <((filesystem|fstream|thread|future|condition_variable|unistd\.h|dlfcn\.h|fcntl\.h|csignal|signal\.h|poll\.h|spawn\.h|sys/[a-z/]+\.h))>)");
    std::smatch match;
    return std::regex_search(text, match, include) ? match[1].str() : "";
}

/// The core runs in a browser too: files, threads and programs are behind its doors.
TEST(Layers, TheCoreKnowsNoOperatingSystem) {
    const Layers layers = layers_of_project();
    std::set<std::string> core = layers.at("compiler/session");
    core.merge(std::set(layers.at("runtime/fit")));
    EXPECT_FALSE(core.count("compiler/import") || core.count("compiler/povray") ||
                 core.count("runtime/system"));
    int sources = 0;
    visit_sources({core.begin(), core.end()}, [&](const fs::path& file, const std::string& text) {
        ++sources;
        EXPECT_EQ(system_header(text), "") << file.string();
    });
    EXPECT_GT(sources, 400);
    EXPECT_EQ(system_header("#include <map>\n#include <thread>\n"), "thread");
    EXPECT_EQ(system_header("#include <sys/stat.h>\n"), "sys/stat.h");
    EXPECT_EQ(system_header("#include <mutex>\n"), "");
}

} // namespace
} // namespace graftal
