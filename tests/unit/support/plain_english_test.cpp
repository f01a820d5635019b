// The rules of CONTRIBUTING.md's "How we write English" that a machine can hold: phrases that nobody may
// write. They hold for the pages, for whatever the program says, and for comments.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Every banned phrase, in small letters, and the phrase to write in its place.
struct Banned {
    const char* phrase;
    const char* instead;
};
constexpr Banned banned[] = {
    {"but for", "except"},
    {"thousand million", "billion"},
    {"is understood", "is the default"},
    {"dearer", "more expensive"},
};

/// The text in small letters, in which a run of blanks is one blank, a new line has lost its comment mark,
/// and strings that continue on a new line are joined. So a phrase is found across lines. `at` gets each
/// letter's place in the text.
std::string flattened(const std::string& text, std::vector<std::size_t>& at) {
    const auto is_one_of = [&](std::size_t i, std::string_view set) {
        return i < text.size() && set.find(text[i]) != std::string_view::npos;
    };
    constexpr std::string_view blanks = " \t\r\n", marks = "/#*<>!";
    std::string flat;
    at.clear();
    const auto keep = [&](char letter, std::size_t place) {
        flat += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        at.push_back(place);
    };
    for (std::size_t i = 0; i < text.size();) {
        const bool quote = text[i] == '"';
        std::size_t end = i + (quote ? 1 : 0);
        while (is_one_of(end, blanks))
            ++end;
        const bool new_line = text.substr(i, end - i).find('\n') != std::string::npos;
        if (quote && new_line && is_one_of(end, "\"")) {
            i = end + 1;
        } else if (quote || end == i) {
            keep(text[i], i);
            ++i;
        } else {
            while (new_line && (is_one_of(end, marks) || is_one_of(end, blanks)))
                ++end;
            if (flat.empty() || flat.back() != ' ') keep(' ', i);
            i = end;
        }
    }
    return flat;
}

bool is_letter(const std::string& text, std::size_t at) {
    return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0;
}

/// The faults of a text, each as "line N: ...". A phrase right after a quotation mark is one that is talked
/// about.
std::vector<std::string> faults_of(const std::string& text) {
    std::vector<std::size_t> at;
    const std::string flat = flattened(text, at);
    std::vector<std::string> faults;
    for (const Banned& ban : banned) {
        const std::string phrase = ban.phrase;
        for (std::size_t found = flat.find(phrase); found != std::string::npos;
             found = flat.find(phrase, found + 1)) {
            const bool word =
                !(found > 0 && is_letter(flat, found - 1)) && !is_letter(flat, found + phrase.size());
            if (!word || (found > 0 && flat[found - 1] == '"')) continue;
            const auto line =
                std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at[found]), '\n') + 1;
            faults.push_back(fmt::format("line {}: \"{}\": write \"{}\"", line, ban.phrase, ban.instead));
        }
    }
    return faults;
}

/// Sentences of a page that begin with "What is" and are no questions.
std::vector<std::string> faulty_subjects(const std::string& page) {
    static const std::regex sentence(R"(([.:!?]\s+|(^|\n)\s*(- )?)(What (is|are|was) [^.:?|]*)([.:?|]))");
    std::vector<std::string> faults;
    for (std::sregex_iterator found(page.begin(), page.end(), sentence), none; found != none; ++found)
        if ((*found)[6] != "?") faults.push_back(fmt::format("name the subject: \"{}\"", (*found)[4].str()));
    return faults;
}

/// Comments of a source that begin with no noun: "What lies here", "Of a file", "As above".
std::vector<std::string> faulty_comments(const std::string& source) {
    static const std::regex beginning(R"(//[/!]?<?\s+((What|Of|As|By|That|Those|The same)\b.*))");
    std::vector<std::string> faults;
    std::istringstream lines(source);
    std::string line;
    std::size_t column_before = std::string::npos; // of the comment of the line before
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::size_t column = line.find("//");
        const bool goes_on = column == column_before && line.find_first_not_of(' ') == column;
        column_before = column;
        if (column == std::string::npos || goes_on) continue;
        const std::string comment = line.substr(column);
        std::smatch found;
        if (std::regex_match(comment, found, beginning))
            faults.push_back(fmt::format("line {}: begin with a noun: \"{}\"", number, found[1].str()));
    }
    return faults;
}

const fs::path root = GRAFTAL_SOURCE_DIR;

std::vector<fs::path> files_in(const std::vector<std::string>& folders,
                               const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    for (const std::string& folder : folders)
        for (const fs::directory_entry& file : fs::recursive_directory_iterator(root / folder))
            if (file.is_regular_file() && extensions.contains(file.path().extension().string()))
                files.push_back(file.path());
    return files;
}

TEST(PlainEnglish, NoBannedPhrases) {
    std::vector<fs::path> files = files_in({"compiler", "runtime", "tools", "docs", "scenes"},
                                           {".md", ".h", ".cpp", ".inst", ".rifs", ".lsys", ""});
    files.push_back(root / "README.md");
    files.push_back(root / "CONTRIBUTING.md");
    EXPECT_GT(files.size(), 500u);
    for (const fs::path& file : files)
        for (const std::string& fault : faults_of(text_of(file)))
            ADD_FAILURE() << file.lexically_relative(root).string() << ": " << fault;
}

TEST(PlainEnglish, SubjectsOfPagesHaveNames) {
    std::vector<fs::path> files = files_in({"compiler", "docs"}, {".md"});
    files.push_back(root / "README.md");
    files.push_back(root / "CONTRIBUTING.md");
    EXPECT_GT(files.size(), 15u);
    for (const fs::path& file : files)
        for (const std::string& fault : faulty_subjects(text_of(file)))
            ADD_FAILURE() << file.lexically_relative(root).string() << ": " << fault;
}

TEST(PlainEnglish, CommentsBeginWithTheirNoun) {
    const std::vector<fs::path> files = files_in({"compiler", "runtime", "tools"}, {".h", ".cpp"});
    EXPECT_GT(files.size(), 500u);
    for (const fs::path& file : files)
        for (const std::string& fault : faulty_comments(text_of(file)))
            ADD_FAILURE() << file.lexically_relative(root).string() << ": " << fault;
}

TEST(PlainEnglish, TheTestFindsFaults) {
    EXPECT_EQ(faults_of("All are left,\n    /// but for\n    /// one.\n").size(), 1u);
    EXPECT_EQ(faults_of("// one\n\"all but \"\n    \"for one\"").front(),
              "line 2: \"but for\": write \"except\"");
    EXPECT_EQ(faults_of("tribut forest; abut for; butforge").size(), 0u);
    EXPECT_EQ(faults_of("Never write \"but for\".").size(), 0u) << "a quotation";
    EXPECT_EQ(faults_of("Two Thousand\n# million.").size(), 1u);
    EXPECT_EQ(faulty_subjects("One. What is too small is left out.").size(), 1u);
    EXPECT_EQ(faulty_subjects("- What is large\nis cut: it goes.\n").size(), 1u);
    EXPECT_EQ(faulty_subjects("What is it? It says what is there.\n").size(), 0u);
    EXPECT_EQ(faulty_subjects("## What is compared\n\n| What is there |").size(), 0u);
    EXPECT_EQ(faulty_comments("int a;\n/// Of a file.\nint b; ///< The same\n").size(), 2u);
    EXPECT_EQ(faulty_comments("int a; // a\n// What it is.\n").front(),
              "line 2: begin with a noun: \"What it is.\"");
    EXPECT_EQ(faulty_comments("int a; ///< The name,\n       ///< As it is.\n").size(), 0u) << "a block";
    EXPECT_EQ(faulty_comments("/// The text.\n///\n/// By rows.\nWhat a;\n").size(), 0u) << "a block";
    EXPECT_EQ(faulty_comments("// Assets. What?\n// The sameness\n").size(), 0u);
}

} // namespace
} // namespace graftal
