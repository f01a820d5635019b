#include "compiler/povray/emit/names.h"

#include <set>

#include <gtest/gtest.h>

#include "compiler/povray/emit/scene.h"

namespace graftal {
namespace {

TEST(PovrayNames, CommentsKeepOnlyHarmlessCharacters) {
    EXPECT_EQ(harmless("tip(3)-a.b+c_d"), "tip(3)-a.b+c_d");
    EXPECT_EQ(harmless("a\n#include \"x\""), "a__include__x_");
    EXPECT_EQ(harmless("*/ }"), "____");
    EXPECT_EQ(harmless("a/b\\c"), "a_b_c");
    EXPECT_EQ(harmless(std::string_view("\0\x80\xff", 3)), "___");
    EXPECT_EQ(harmless(std::string(500, 'a')).size(), 60u);
}

TEST(PovrayNames, IdentifiersAreLettersDigitsAndUnderscores) {
    EXPECT_EQ(identifier_part("tip(3)"), "tip_3");
    EXPECT_EQ(identifier_part("leaf.llr"), "leaf_llr");
    EXPECT_EQ(identifier_part("\xc3\xa9t\xc3\xa9"), "__t");
    EXPECT_EQ(identifier_part("((("), "");
    EXPECT_EQ(identifier_part(std::string(500, 'a')).size(), 24u);
}

TEST(PovrayNames, ModelsAreNeverPovrayWords) {
    EXPECT_EQ(model_identifier("union"), "Union");
    EXPECT_EQ(model_identifier("Fern"), "Fern");
    EXPECT_EQ(model_identifier("2d"), "Model_2d");
    EXPECT_EQ(model_identifier(""), "Model_");
    EXPECT_EQ(model_identifier("-"), "Model_");
    EXPECT_EQ(model_identifier("crystal.rifs"), "Crystal") << "without the ending";
    EXPECT_EQ(model_identifier("a.b.lsys"), "A_b");
    for (const char* const good : {"Crystal", "A", "Far_fern_2"})
        EXPECT_TRUE(is_model_identifier(good)) << good;
    for (const char* const bad :
         {"", "union", "2d", "A b", "A_", "_A", "\xc3\x84", "Aaaaaaaaaaaaaaaaaaaaaaaaaaa"})
        EXPECT_FALSE(is_model_identifier(bad)) << bad;
}

TEST(PovrayNames, NamesDifferWhateverIsWished) {
    UniqueNames names("M_");
    std::set<std::string> all;
    const char* const wishes[] = {"a", "a",    "a_2", "a",   "a_2", "a_2_2", "",
                                  "",  "a(2)", "a.2", "a_3", "a_4", "a"};
    for (const char* const wish : wishes) {
        const std::string name = names.next(wish);
        EXPECT_EQ(name.substr(0, 2), "M_");
        EXPECT_TRUE(all.insert(name).second) << name;
    }
    EXPECT_TRUE(all.contains("M_a"));
}

TEST(PovrayNames, ManyEqualWishesAreFast) {
    UniqueNames names("M_");
    std::set<std::string> all;
    for (int i = 0; i < 100'000; ++i)
        all.insert(names.next("leaf"));
    EXPECT_EQ(all.size(), 100'000u);
}

} // namespace
} // namespace graftal
