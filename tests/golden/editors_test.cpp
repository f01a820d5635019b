// `format` and `lsp`, as editors and people run them.

#include "tests/golden/command_line.h"

#include <gmock/gmock.h>

namespace graftal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Editors : public CommandLine {};

TEST_F(Editors, FormatLaysFilesOut) {
    write("a.inst", "object a{\n  cube   # kept\n}");
    write("b.inst", "object b {\n    cube\n}\n");
    const RunResult check = graftal("format --check a.inst b.inst");
    EXPECT_EQ(check.status, 1);
    EXPECT_EQ(check.out, "a.inst\n");
    EXPECT_EQ(graftal("format a.inst b.inst").status, 0);
    EXPECT_EQ(read("a.inst"), "object a {\n    cube   # kept\n}\n");
    EXPECT_EQ(graftal("format --check a.inst b.inst").status, 0);
    EXPECT_EQ(graftal("format - < a.inst").out, read("a.inst"));
    EXPECT_EQ(files(), "a.inst b.inst");
}

TEST_F(Editors, FormatLeavesFaultyFilesAsTheyAre) {
    write("a.inst", "object a {");
    const RunResult result = graftal("format a.inst");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("a.inst:1:11: error: "));
    EXPECT_EQ(read("a.inst"), "object a {");
    write("a.txt", "object a { cube }");
    EXPECT_THAT(graftal("format a.txt").err, HasSubstr("the names of models end in .lsys, .rifs or .inst"));
    EXPECT_EQ(graftal("format none.inst").status, 3);
}

/// A message of the protocol, as `printf` writes it.
std::string message(const std::string& json) {
    return "printf 'Content-Length: " + std::to_string(json.size()) + "\\r\\n\\r\\n%s' '" + json + "'; ";
}

TEST_F(Editors, LspServesUntilItIsToldToEnd) {
    const std::string script =
        message(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{}})") +
        message(
            R"({"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":"file:///m.inst","version":1,"text":"object m { cub }"}}})") +
        "for i in $(seq 600); do grep -q publishDiagnostics out && break; sleep 0.1; done; " +
        message(R"({"jsonrpc":"2.0","id":2,"method":"shutdown"})") +
        message(R"({"jsonrpc":"2.0","method":"exit"})");
    const RunResult result = shell(": > out; ( " + script + " ) | \"$graftal\" lsp >> out");
    const std::string out = read("out");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(out, AllOf(HasSubstr("\"capabilities\""), HasSubstr("textDocument/publishDiagnostics"),
                           HasSubstr("did you mean 'cube'?"), HasSubstr("\"id\":2")));
    EXPECT_EQ(result.err, "");
}

TEST_F(Editors, LspEndsWithItsInput) {
    EXPECT_EQ(shell("\"$graftal\" lsp < /dev/null").status, 1);
    const RunResult result = shell("printf 'Hello\\r\\n\\r\\n' | \"$graftal\" lsp");
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "graftal: lsp: a message has no length\n");
}

} // namespace
} // namespace graftal
