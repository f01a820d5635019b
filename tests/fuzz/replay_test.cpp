// What the fuzzers keep, and changes to it, through all targets of tests/fuzz without libFuzzer.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "compiler/languages/lower.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/syntax_mutator.h"

namespace graftal::fuzz {

void PrintTo(const Target& target, std::ostream* out) {
    *out << target.name;
}

namespace {

std::string source_path(const std::string& name) {
    return std::string(GRAFTAL_SOURCE_DIR) + "/" + name;
}

/// What is kept for a target: in its own folder, or in that of the language that its name begins with
/// (`lsys_lower`).
std::vector<Input> kept_for(const std::string& target) {
    const std::string own = source_path("tests/fuzz/corpus/" + target);
    if (std::filesystem::exists(own)) return files_of(own);
    return files_of(source_path("tests/fuzz/corpus/" + target.substr(0, target.find('_'))));
}

/// The targets say much, as the program would.
class Quiet {
  public:
    Quiet() {
        const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
        for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
            std::fflush(nullptr);
            kept_[stream - 1] = ::dup(stream);
            ::dup2(null, stream);
        }
        ::close(null);
    }
    ~Quiet() {
        std::fflush(nullptr);
        for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
            ::dup2(kept_[stream - 1], stream);
            ::close(kept_[stream - 1]);
        }
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

  private:
    int kept_[2] = {};
};

/// What the target threw, or "".
std::string thrown(const Target& target, const std::string& bytes) {
    const Quiet quiet;
    try {
        target.run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    } catch (const std::exception& fault) {
        return fault.what();
    }
    return {};
}

class Replay : public ::testing::TestWithParam<Target> {};

TEST_P(Replay, KeptInputs) {
    const std::vector<Input> inputs = kept_for(GetParam().name);
    ASSERT_FALSE(inputs.empty());
    for (const Input& input : inputs)
        EXPECT_EQ(thrown(GetParam(), input.bytes), "") << input.name;
}

// libFuzzer names what it finds by a hash of 40 digits. What is kept was chosen, made small and named by
// hand.
TEST(Corpus, WasChosenByHand) {
    namespace fs = std::filesystem;
    int kept = 0;
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(source_path("tests/fuzz/corpus"))) {
        if (!entry.is_regular_file()) continue;
        ++kept;
        const std::string name = entry.path().filename().string();
        EXPECT_FALSE(name.size() == 40 && name.find_first_not_of("0123456789abcdef") == std::string::npos)
            << entry.path();
        EXPECT_LE(entry.file_size(), 20'000u) << entry.path();
    }
    EXPECT_GE(kept, 50);
    EXPECT_LE(kept, 1'000);
}

TEST_P(Replay, ChangesToThem) {
    const std::vector<Input> inputs = kept_for(GetParam().name);
    ASSERT_FALSE(inputs.empty());
    constexpr int changes = 60;
    graftal::testing::Choices choices(std::uint64_t{1});
    SyntaxMutator mutator;
    for (int i = 0; i < changes; ++i) {
        const std::string bytes = changed(GetParam(), inputs, 4000, mutator, choices);
        EXPECT_EQ(thrown(GetParam(), bytes), "") << "change " << i << ":\n" << bytes;
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(targets()),
                         [](const ::testing::TestParamInfo<Target>& target) { return target.param.name; });

bool is_model(const std::string& language, const std::string& text) {
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.max_objects = 200;
    options.max_modules = 20'000;
    return lower_text("no_such_folder/model." + language, text, options, sources, diagnostics)
        .graph.has_value();
}

// A mutator that only makes rubbish tries nothing but the parsers' complaints.
TEST(SyntaxMutator, ManyChangedModelsAreModels) {
    for (const std::string language : {"inst", "rifs", "lsys"}) {
        graftal::testing::Choices choices(std::uint64_t{7});
        SyntaxMutator mutator;
        int models = 0, tried = 0;
        for (const Input& input : kept_for(language)) {
            if (!is_model(language, input.bytes)) continue;
            mutator.learn(input.bytes, choices);
            for (int i = 0; i < 25; ++i) {
                const std::string text = mutator.mutate(input.bytes, 4000, choices);
                if (text.empty()) continue;
                EXPECT_NE(text, input.bytes);
                ++tried;
                models += is_model(language, text);
            }
        }
        EXPECT_GE(tried, 100) << language;
        EXPECT_GT(models, tried / 5) << language << ": " << models << " of " << tried;
    }
}

TEST(SyntaxTree, IsNothingWhereBracketsDoNotMatch) {
    for (const char* text : {"a (", "a )", "{ ( }", "[ { ] }"})
        EXPECT_FALSE(read_syntax(text)) << text;
    EXPECT_FALSE(read_syntax(std::string(65, '(') + std::string(65, ')')));
    EXPECT_TRUE(read_syntax(std::string(64, '(') + std::string(64, ')')));
}

TEST(SyntaxTree, HoldsStatementsCallsAndItems) {
    const auto nodes = read_syntax("object a { union: f(2, g(x)) scale: 1/2\n translate: 1, 2, 3 }");
    ASSERT_TRUE(nodes);
    const auto count = [&](Part part) {
        return std::count_if(nodes->begin(), nodes->end(),
                             [&](const SyntaxNode& node) { return node.part == part; });
    };
    EXPECT_EQ(count(Part::block), 1);
    EXPECT_EQ(count(Part::statement), 4); // the object and its three lines
    EXPECT_EQ(count(Part::call), 2);
    EXPECT_EQ(count(Part::item), 5); // 2 and g(x), x, and what follows the commas of the last line
}

} // namespace
} // namespace graftal::fuzz
