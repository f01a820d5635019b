// Each header includes what it uses of the standard library, itself or by a header that it includes. What is
// precompiled hides the want of these from every build.

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;

/// A precompiled header, and names that nothing else gives.
struct Given {
    const char* header;
    std::vector<std::string_view> names;
};
const Given precompiled[] = {
    {"algorithm",
     {"std::min", "std::max", "std::clamp", "std::sort", "std::find_if", "std::any_of", "std::all_of"}},
    {"fmt/format.h", {"fmt::format"}},
    {"functional", {"std::function", "std::less", "std::plus", "std::hash"}},
    {"map", {"std::map", "std::multimap"}},
    {"memory",
     {"std::unique_ptr", "std::shared_ptr", "std::weak_ptr", "std::make_unique", "std::make_shared"}},
    {"optional", {"std::optional", "std::nullopt"}},
    {"sstream", {"std::istringstream", "std::ostringstream", "std::stringstream"}},
    {"string", {"std::string", "std::to_string"}},
    {"unordered_map", {"std::unordered_map"}},
    {"variant", {"std::variant", "std::visit", "std::monostate"}},
    {"vector", {"std::vector"}},
};

struct Header {
    std::string code; ///< without comments
    std::vector<std::string> project;
    std::set<std::string> standard;
};
using Headers = std::map<std::string, Header>;

Header header_of(const std::string& text) {
    Header header;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        line = line.substr(0, line.find("//"));
        header.code += line + '\n';
        const std::size_t open = line.find_first_of("<\""), close = line.find_last_of(">\"");
        if (!line.starts_with("#include") || close == std::string::npos) continue;
        const std::string name = line.substr(open + 1, close - open - 1);
        if (line[open] == '<')
            header.standard.insert(name);
        else
            header.project.push_back(name);
    }
    return header;
}

bool uses(const std::string& code, std::string_view name) {
    const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t at = code.find(name); at != std::string::npos; at = code.find(name, at + 1))
        if (!in_word(code[at + name.size()])) return true;
    return false;
}

/// Standard headers that one gives, with those that it includes.
const std::set<std::string>& given_by(const std::string& name, const Headers& headers,
                                      std::map<std::string, std::set<std::string>>& known) {
    const auto [place, is_new] = known.try_emplace(name);
    const auto header = headers.find(name);
    if (!is_new || header == headers.end()) return place->second;
    std::set<std::string> given = header->second.standard;
    for (const std::string& included : header->second.project)
        given.merge(std::set(given_by(included, headers, known)));
    return known[name] = std::move(given);
}

std::vector<std::string> faults_of(const Headers& headers) {
    std::vector<std::string> faults;
    std::map<std::string, std::set<std::string>> known;
    for (const auto& [name, header] : headers)
        for (const Given& given : precompiled)
            for (const std::string_view used : given.names)
                if (!given_by(name, headers, known).contains(given.header) && uses(header.code, used))
                    faults.push_back(name + " uses " + std::string(used) + " without <" + given.header + ">");
    return faults;
}

TEST(Headers, IncludeWhatIsPrecompiled) {
    const fs::path root = GRAFTAL_SOURCE_DIR;
    Headers headers;
    for (const char* const folder : {"compiler", "runtime", "tools"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            if (entry.path().extension() != ".h") continue;
            std::ifstream file(entry.path());
            headers[entry.path().lexically_relative(root).string()] =
                header_of({std::istreambuf_iterator<char>(file), {}});
        }
    EXPECT_GT(headers.size(), 400u);
    for (const std::string& fault : faults_of(headers))
        ADD_FAILURE() << fault;
}

TEST(Headers, TheTestFindsFaults) {
    const auto faults = [](const std::string& low, const std::string& high) {
        return faults_of({{"low.h", header_of(low)}, {"high.h", header_of("#include \"low.h\"\n" + high)}});
    };
    EXPECT_EQ(faults("", "std::vector<int> a; // <vector>\n").front(),
              "high.h uses std::vector without <vector>");
    EXPECT_EQ(faults("#include <vector>\n", "std::vector<int> a;\n").size(), 0u);
    EXPECT_EQ(faults("std::optional<int> a;\n", "#include <optional>\n").size(), 1u) << "the other way round";
    EXPECT_EQ(faults("", "std::string_view a; // std::string\n").size(), 0u);
}

} // namespace
} // namespace graftal
