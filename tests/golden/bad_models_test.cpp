// Every model in tests/golden/bad is wrong, and the file beside it with the ending .expected holds exactly
// what is said about it. GRAFTAL_REWRITE_EXPECTED=1 in the environment writes those files anew: look at the
// difference before committing it.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

const std::filesystem::path folder = std::filesystem::path(GRAFTAL_SOURCE_DIR) / "tests/golden/bad";

std::vector<std::string> bad_models() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() != ".expected")
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

class BadModel : public ::testing::TestWithParam<std::string> {};

TEST_P(BadModel, is_explained) {
    std::filesystem::current_path(folder); // so that messages name the file and not the machine
    Compilation compilation;
    const std::shared_ptr<const AnalysedModel> model =
        Session(GetParam(), disk_files()).analysed({}, compilation);
    EXPECT_TRUE(compilation.status.ok()) << compilation.status.message();
    EXPECT_FALSE(model);
    EXPECT_TRUE(compilation.diagnostics.has_errors());

    const std::string expected_path = GetParam() + ".expected";
    const std::string found = compilation.diagnostics.render(compilation.sources);
    if (std::getenv("GRAFTAL_REWRITE_EXPECTED")) {
        ASSERT_TRUE(write_text(expected_path, found).ok());
        return;
    }
    std::string expected;
    ASSERT_TRUE(read_text(expected_path, expected).ok()) << "no expectation; what is said:\n" << found;
    EXPECT_EQ(found, expected);
}

INSTANTIATE_TEST_SUITE_P(Golden, BadModel, ::testing::ValuesIn(bad_models()), [](const auto& param_info) {
    std::string name = param_info.param;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
    return name;
});

} // namespace
} // namespace graftal
