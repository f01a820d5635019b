#include "compiler/editing/words.h"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(Words, EachWordOfTheParsersHasAMeaning) {
    std::size_t count = 0;
    for (const WordPlace place : all_word_places())
        for (const std::string_view word : words_in(place)) {
            const Word* const meaning = word_in(place, word);
            ASSERT_TRUE(meaning) << word << " at place " << static_cast<int>(place);
            EXPECT_FALSE(meaning->doc.empty()) << word;
            EXPECT_NE(meaning->form.find(word), std::string_view::npos) << word;
            ++count;
        }
    EXPECT_GT(count, 250u);
    EXPECT_FALSE(word_in(WordPlace::haze, "angle"));
}

std::string for_table(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\\|");
    return text;
}

/// The table of symbols, and that of primitives, in docs/language.md.
TEST(Words, SymbolsAndEnvironmentsReadAsInTheDocumentation) {
    std::ifstream file(GRAFTAL_SOURCE_DIR "/docs/language.md");
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    for (const WordPlace place : {WordPlace::turtle, WordPlace::environment})
        for (const std::string_view word : words_in(place)) {
            const Word& meaning = *word_in(place, word);
            EXPECT_NE(text.find("| " + for_table(std::string(meaning.doc)) + " |"), std::string::npos)
                << word;
            EXPECT_NE(text.find("`" + for_table(std::string(meaning.form)) + "`"), std::string::npos) << word;
        }
    for (const std::string_view word : words_in(WordPlace::primitive)) {
        const Word& meaning = *word_in(WordPlace::primitive, word);
        EXPECT_NE(text.find("| `" + std::string(meaning.form) + "` |"), std::string::npos) << word;
    }
}

} // namespace
} // namespace graftal
