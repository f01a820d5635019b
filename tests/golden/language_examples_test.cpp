// Every example of docs/language.md and docs/card.md that is marked as a model (```lsys or ```inst) is a
// whole file that compiles without a word, L-systems in both ways in which they may be compiled.

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

struct Example {
    std::string text;
    std::size_t line = 0; ///< of its first line in the page
};

std::vector<Example> examples(const std::string& page, const std::string& language) {
    const std::string opening = "\n```" + language + "\n", closing = "\n```\n";
    std::vector<Example> found;
    for (std::size_t at = page.find(opening); at != std::string::npos; at = page.find(opening, at)) {
        at += opening.size();
        const std::size_t end = page.find(closing, at);
        const auto line = 1 + static_cast<std::size_t>(std::count(
                                  page.begin(), page.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
        found.push_back({page.substr(at, end - at) + "\n", line});
        at = end;
    }
    return found;
}

void compile_examples(const std::string& file, const std::string& language, std::size_t at_least) {
    const std::filesystem::path root = GRAFTAL_SOURCE_DIR;
    std::string page;
    ASSERT_TRUE(read_text((root / file).string(), page).ok());
    const std::vector<Example> found = examples(page, language);
    EXPECT_GE(found.size(), at_least);
    for (const Example& example : found)
        for (const bool exact : {false, true}) {
            SourceMap sources;
            Diagnostics diagnostics;
            LowerOptions options;
            options.exact = exact;
            // Beside the models that examples use.
            const std::string name = (root / "scenes/ifs/example.").string() + language;
            const std::optional<Graph> graph =
                lower_text(name, example.text, options, sources, diagnostics, {.files = &disk_files()}).graph;
            EXPECT_TRUE(graph) << file << ":" << example.line;
            EXPECT_EQ(diagnostics.render(sources), "") << file << ":" << example.line;
        }
}

TEST(Language, ExamplesCompile) {
    compile_examples("docs/language.md", "lsys", 18);
    compile_examples("docs/language.md", "inst", 1);
    for (const char* language : {"lsys", "rifs", "inst"})
        compile_examples("docs/card.md", language, 1);
}

} // namespace
} // namespace graftal
