#include "compiler/syntax/scene_statements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using ::testing::HasSubstr;

TEST(SceneStatements, a_string_in_an_unknown_field_begins_no_field) {
    SourceMap sources;
    Diagnostics diagnostics;
    const FileId file = sources.add("t.inst", "material moss { picture: \"color\"  diffuse: 0.5 }");
    TokenStream stream(lex(sources, file, diagnostics), diagnostics);
    std::vector<SceneStatement> statements;
    parse_scene_statement(stream, statements);
    EXPECT_EQ(diagnostics.error_count(), 1U) << diagnostics.render(sources);
    EXPECT_THAT(diagnostics.render(sources), HasSubstr("'material' has no field 'picture'"));
    ASSERT_EQ(statements.front().fields.size(), 1U);
    EXPECT_EQ(statements.front().fields.front().keyword, "diffuse");
}

} // namespace
} // namespace graftal
