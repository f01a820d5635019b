// The files for editors in share/ know every word of the languages. Their rules are tested elsewhere
// (tests/grammar).

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "compiler/graph/primitive.h"
#include "compiler/inst/parse/repeat.h"
#include "compiler/languages/languages.h"
#include "compiler/syntax/expression_functions.h"
#include "compiler/syntax/scene_statements.h"
#include "compiler/syntax/transform.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

std::set<std::string> words_of_languages() {
    std::set<std::string> words(scene_keywords().begin(), scene_keywords().end());
    for (const Language& language : languages()) {
        words.insert(language.keywords.begin(), language.keywords.end());
        words.insert(language.inner_keywords.begin(), language.inner_keywords.end());
    }
    words.insert(transform_keywords.begin(), transform_keywords.end());
    words.insert(body_keywords().begin(), body_keywords().end());
    for (const PrimitiveKind kind : all_primitive_kinds)
        words.insert(std::string(name_of(kind)));
    for (const ExpressionFunction& function : expression_functions())
        words.insert(function.name);
    return words;
}

/// The words of a file that stand between two of these characters, as in "(scale|rotate)".
std::set<std::string> words_between(const std::string& file, const std::string& separators) {
    std::string text;
    EXPECT_TRUE(read_text((std::filesystem::path(GRAFTAL_SOURCE_DIR) / "share" / file).string(), text).ok());
    std::set<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
        words.insert(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

TEST(Editors, KnowEveryWordOfTheLanguages) {
    const std::set<std::string> textmate = words_between("graftal.tmLanguage.json", "(|)");
    const std::set<std::string> vim = words_between("vim/syntax/graftal.vim", " \n\\<>");
    const std::set<std::string> words = words_of_languages();
    EXPECT_GE(words.size(), 80U);
    for (const std::string& word : words) {
        EXPECT_TRUE(textmate.contains(word)) << "TextMate does not know " << word;
        EXPECT_TRUE(vim.contains(word)) << "Vim does not know " << word;
    }
}

} // namespace
} // namespace graftal
