// A namespace defines each name of a type once. Two classes of one name are one to the linker: it keeps
// either's destructor for both.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

namespace fs = std::filesystem;
using Tokens = std::vector<std::string_view>;

bool is_word_letter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Where the literal or comment that begins at `at` ends; `at` if none begins there.
std::size_t end_of_text(std::string_view code, std::size_t at) {
    const auto after = [&](std::string_view mark, std::size_t from) {
        const std::size_t found = code.find(mark, from);
        return found == std::string_view::npos ? code.size() : found + mark.size();
    };
    if (code.substr(at, 2) == "//") return std::min(code.find('\n', at), code.size());
    if (code.substr(at, 2) == "/*") return after("*/", at + 2);
    if (code.substr(at, 2) == "R\"") {
        const std::size_t open = code.find('(', at);
        return after(fmt::format("){}\"", code.substr(at + 2, open - at - 2)), open);
    }
    // An apostrophe in a number separates digits.
    if (code[at] != '"' && (code[at] != '\'' || (at > 0 && is_word_letter(code[at - 1])))) return at;
    std::size_t end = at + 1;
    while (end < code.size() && code[end] != code[at])
        end += code[end] == '\\' ? 2 : 1;
    return end + 1;
}

/// The words and marks of a source, without its comments, literals and directives. "::" is one mark.
Tokens tokens_of(std::string_view code) {
    Tokens tokens;
    bool line_begins = true;
    for (std::size_t at = 0; at < code.size();) {
        std::size_t end = end_of_text(code, at);
        if (line_begins && code[at] == '#') {
            end = code.find('\n', at);
            while (end != std::string_view::npos && code[end - 1] == '\\')
                end = code.find('\n', end + 1);
        } else if (end == at) {
            do {
                ++end;
            } while (end < code.size() && is_word_letter(code[at]) && is_word_letter(code[end]));
            if (code.substr(at, 2) == "::") ++end;
            if (!std::isspace(static_cast<unsigned char>(code[at])))
                tokens.push_back(code.substr(at, end - at));
        }
        line_begins = code[at] == '\n' || (line_begins && std::isspace(static_cast<unsigned char>(code[at])));
        if (end == std::string_view::npos) break;
        at = end;
    }
    return tokens;
}

/// Past a list in brackets that begins at `at`, if one does.
std::size_t past_list(const Tokens& tokens, std::size_t at, std::string_view open, std::string_view close) {
    int depth = 0;
    do {
        if (at >= tokens.size()) return at;
        depth += tokens[at] == open ? 1 : tokens[at] == close ? -1 : 0;
        at += depth > 0 || tokens[at] == close ? 1 : 0;
    } while (depth > 0);
    return at;
}

/// The name of the type that a statement, up to its brace or semicolon, defines; empty if it defines none.
std::string defined_type(const Tokens& statement, bool has_body) {
    std::size_t at = 0;
    const auto word = [&] { return at < statement.size() ? statement[at] : std::string_view(); };
    if (word() == "template") at = past_list(statement, at + 1, "<", ">");
    if (word() == "using" && at + 2 < statement.size() && statement[at + 2] == "=")
        return std::string(statement[at + 1]);
    const bool is_enum = word() == "enum";
    if (!has_body || (!is_enum && word() != "class" && word() != "struct" && word() != "union")) return {};
    ++at;
    if (is_enum && (word() == "class" || word() == "struct")) ++at;
    at = past_list(statement, at, "[", "]");
    if (word() == "alignas") at = past_list(statement, at + 1, "(", ")");
    std::string name;
    for (; at < statement.size() && word() != ":" && word() != "final"; ++at) {
        if (word() == "(" || word() == "=") return {}; // a function or a variable
        name += word();
    }
    return name;
}

/// Types, with their namespaces, that a source defines outside of classes, functions and unnamed namespaces.
std::vector<std::string> types_of(std::string_view code) {
    constexpr std::string_view unnamed = "(unnamed)", no_namespace = "(body)";
    std::vector<std::string> types, scopes;
    Tokens statement;
    for (const std::string_view token : tokens_of(code)) {
        if (token != "{" && token != "}" && token != ";") {
            statement.push_back(token);
            continue;
        }
        bool hidden = false;
        for (const std::string& scope : scopes)
            hidden = hidden || scope == unnamed || scope == no_namespace;
        const std::string name = hidden || token == "}" ? "" : defined_type(statement, token == "{");
        if (!name.empty())
            types.push_back(fmt::format("{}{}{}", fmt::join(scopes, "::"), scopes.empty() ? "" : "::", name));
        if (token == "{") {
            const bool opens = !statement.empty() && statement[0] == "namespace";
            scopes.push_back(!opens ? std::string(no_namespace)
                             : statement.back() == "namespace"
                                 ? std::string(unnamed)
                                 : fmt::format("{}", fmt::join(statement.begin() + 1, statement.end(), "")));
        } else if (token == "}" && !scopes.empty()) {
            scopes.pop_back();
        }
        statement.clear();
    }
    EXPECT_TRUE(scopes.empty()) << "braces that do not match";
    return types;
}

TEST(TypeNames, ANamespaceDefinesEachOnce) {
    const fs::path root = GRAFTAL_SOURCE_DIR;
    std::map<std::string, std::vector<std::string>> files_of_type;
    for (const char* const folder : {"compiler", "runtime", "tools", "tests"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const fs::path& path = entry.path();
            if (!entry.is_regular_file() || (path.extension() != ".h" && path.extension() != ".cpp"))
                continue;
            SCOPED_TRACE(path);
            std::ifstream file(path);
            const std::string code{std::istreambuf_iterator<char>(file), {}};
            for (const std::string& type : types_of(code))
                files_of_type[type].push_back(path.lexically_relative(root).string());
        }
    EXPECT_GT(files_of_type.size(), 800u);
    for (const auto& [type, files] : files_of_type)
        EXPECT_EQ(files.size(), 1u) << type << " is defined in "
                                    << fmt::format("{}", fmt::join(files, " and in "));
}

TEST(TypeNames, TheTestFindsThem) {
    const auto types = [](std::string_view code) {
        return fmt::format("{}", fmt::join(types_of(code), " "));
    };
    EXPECT_EQ(types("namespace a {\nclass B : public C {\n struct Inner {}; };\nclass Later;\n}"), "a::B");
    EXPECT_EQ(types("namespace a { namespace { struct B {}; } struct C final {}; }"), "a::C");
    EXPECT_EQ(types("namespace a::b { enum class E : int { one }; union U {}; enum Old { two }; }"),
              "a::b::E a::b::U a::b::Old");
    EXPECT_EQ(
        types("template<typename T, int n = 3> struct V { T x[n]; }; struct [[nodiscard]] alignas(16) W {};"),
        "V W");
    EXPECT_EQ(types("template<> struct hash<A> { int i; }; struct A::Kernel { int j; };"),
              "hash<A> A::Kernel");
    EXPECT_EQ(types("using Id = int; using std::string; template<class T> using List = vector<T>;"),
              "Id List");
    EXPECT_EQ(types("struct A f() { struct Local {}; return {}; } struct A a = {}; struct { int x; } b;"),
              "");
    EXPECT_EQ(types("#define X struct Y { \\\n };\n// struct A {};\n/* struct B {}; */ const char* c = "
                    "\"struct C {\";"
                    "char d = '{', e = '\\'', f = 1'000; auto g = R\"(struct D {)\"; struct Real {};"),
              "Real");
}

} // namespace
} // namespace graftal
