// Messages name what the library has, where the command line has options.

#include "runtime/graftal/library_words.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace graftal::v1 {
namespace {

/// Each option that a message of the compiler or of the runtime names has a name in the library, or concerns
/// the command line only.
TEST(LibraryWords, AreKnownForEveryOptionThatMessagesName) {
    static const std::set<std::string> of_commands = {
        "--aovs",    "--at",        "--card",  "--boxes",       "--denoise", "--device",      "--blocks",
        "--exact",   "--tolerance", "--light", "--maps",        "--preset",  "--threshold",   "--transparent",
        "--flatten", "--keep",      "--noise", "--progressive", "--tile",    "--visible-only"};
    static const std::regex literal("\"([^\"\\\\]|\\\\.)*\""), option("--[a-z][a-z-]*");
    std::set<std::string> seen;
    for (const char* const folder : {"/compiler", "/runtime"}) {
        for (const auto& file :
             std::filesystem::recursive_directory_iterator(GRAFTAL_SOURCE_DIR + std::string(folder))) {
            const std::string extension = file.path().extension().string(), path = file.path().string();
            // Texts of farms and of the studio name commands; the other file has the names themselves.
            if ((extension != ".cpp" && extension != ".h") || path.find("/farm/") != std::string::npos ||
                path.find("/studio/") != std::string::npos || path.find("library_words") != std::string::npos)
                continue;
            std::ifstream in(file.path());
            for (std::string line; std::getline(in, line);) {
                if (line.find("///") != std::string::npos) continue;
                for (std::sregex_iterator text(line.begin(), line.end(), literal), end; text != end; ++text) {
                    const std::string words = text->str();
                    for (std::sregex_iterator at(words.begin(), words.end(), option); at != end; ++at)
                        seen.insert(at->str());
                }
            }
        }
    }
    EXPECT_GE(seen.size(), 15u);
    for (const std::string& name : seen)
        if (!of_commands.contains(name)) {
            EXPECT_NE(in_library_words(name), name);
        }
    EXPECT_EQ(in_library_words("add 'steps 5' to it, or give '--steps 5' with --memory"),
              "add 'steps 5' to it, or give 'steps(5)' with memory()");
}

} // namespace
} // namespace graftal::v1
