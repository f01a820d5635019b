#include "runtime/lsp/language_server.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "compiler/support/counter_random.h"
#include "runtime/lsp/message_stream.h"
#include "runtime/lsp/uri.h"
#include "runtime/system/disk_files.h"

namespace graftal {
namespace {

using Json = nlohmann::json;

/// An editor that follows a script.
class Editor {
  public:
    Editor() : server_(disk_files(), [this](const std::string& text) { take(text); }) {}

    void send(const Json& message) {
        server_.receive(message.dump(-1, ' ', false, Json::error_handler_t::replace));
    }
    void send_text(const std::string& text) { server_.receive(text); }
    void tell(const std::string& method, Json parameters) {
        send({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}});
    }
    /// The whole answer to a request, which comes at once.
    Json ask(const std::string& method, Json parameters) {
        const int id = ++last_id_;
        send({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", std::move(parameters)}});
        EXPECT_TRUE(answers_.contains(id)) << method;
        return answers_[id];
    }
    Json result(const std::string& method, Json parameters) {
        const Json answer = ask(method, std::move(parameters));
        EXPECT_TRUE(answer.contains("result")) << answer.dump();
        return answer.contains("result") ? answer["result"] : Json();
    }
    void begin() { capabilities = result("initialize", {{"processId", nullptr}})["capabilities"]; }
    void open(const std::string& uri, const std::string& text) {
        tell("textDocument/didOpen",
             {{"textDocument", {{"uri", uri}, {"languageId", "graftal"}, {"version", 1}, {"text", text}}}});
    }
    void work() {
        while (server_.has_work())
            server_.work({});
    }

    Json capabilities;
    std::map<std::string, Json> findings; ///< by URI, the last
    std::size_t published = 0;
    LanguageServer& server() { return server_; }
    std::size_t answers() const { return answers_.size(); }

  private:
    void take(const std::string& text) {
        const Json message = Json::parse(text);
        EXPECT_EQ(message["jsonrpc"], "2.0");
        if (message.contains("id") && message["id"].is_number_integer())
            answers_[message["id"].get<int>()] = message;
        if (message.value("method", "") != "textDocument/publishDiagnostics") return;
        findings[message["params"]["uri"]] = message["params"]["diagnostics"];
        ++published;
    }

    LanguageServer server_;
    std::map<int, Json> answers_;
    int last_id_ = 0;
};

Json at(const std::string& uri, int line, int character) {
    return {{"textDocument", {{"uri", uri}}}, {"position", {{"line", line}, {"character", character}}}};
}

const std::string uri = "file:///nowhere/m.rifs";
const std::string leaf = "# a leaf \xC3\xA9\xF0\x9F\x8C\xB2\nlet lean = 30\nrifs leaf {\n"
                         "  map a { scale 1/2  rotate z, lean }\n  map b { scale 1/2  translate 1, 0 }\n}\n";

TEST(LanguageServer, AnswersWhatEditorsAsk) {
    Editor editor;
    editor.begin();
    EXPECT_EQ(editor.capabilities["renameProvider"]["prepareProvider"], true);
    editor.open(uri, leaf);
    editor.work();
    EXPECT_EQ(editor.findings[uri], Json::array());

    const Json items = editor.result("textDocument/completion", at(uri, 3, 34))["items"]; // behind `lea`
    ASSERT_FALSE(items.empty());
    EXPECT_EQ(items[0]["label"], "lean");
    EXPECT_EQ(items[0]["textEdit"]["range"]["start"]["character"], 31);
    EXPECT_EQ(
        editor.result("textDocument/hover", at(uri, 3, 12))["contents"]["value"].get<std::string>().substr(0,
                                                                                                           8),
        "`scale: ");
    // Once the model is known, hovers tell its size.
    EXPECT_NE(editor.result("textDocument/hover", at(uri, 2, 6))["contents"]["value"].get<std::string>().find(
                  "Box from"),
              std::string::npos);
    EXPECT_EQ(editor.result("textDocument/definition", at(uri, 3, 32))["range"]["start"]["line"], 1);
    EXPECT_EQ(editor.result("textDocument/prepareRename", at(uri, 3, 32))["end"]["character"], 35);
    Json renaming = at(uri, 3, 32);
    renaming["newName"] = "turn";
    EXPECT_EQ(editor.result("textDocument/rename", renaming)["changes"][uri].size(), 2u);
    renaming["newName"] = "a b";
    EXPECT_EQ(editor.ask("textDocument/rename", renaming)["error"]["code"], -32803);
    const Json symbols = editor.result("textDocument/documentSymbol", {{"textDocument", {{"uri", uri}}}});
    std::string names;
    for (const Json& symbol : symbols)
        names += symbol["name"].get<std::string>() + " ";
    EXPECT_EQ(names, "lean leaf a b ");
    EXPECT_EQ(editor.result("textDocument/formatting",
                            {{"textDocument", {{"uri", uri}}}, {"options", Json::object()}}),
              Json::array());
    EXPECT_EQ(editor.ask("textDocument/foldingRange", at(uri, 0, 0))["error"]["code"], -32601);
    EXPECT_EQ(editor.ask("textDocument/hover", at("file:///other", 0, 0))["error"]["code"], -32602);

    editor.result("shutdown", nullptr);
    EXPECT_EQ(editor.ask("textDocument/hover", at(uri, 0, 0))["error"]["code"], -32600);
    editor.tell("exit", nullptr);
    EXPECT_TRUE(editor.server().ended());
    EXPECT_EQ(editor.server().exit_status(), 0);
}

TEST(LanguageServer, PublishesWhatTheCommandLineSays) {
    Editor editor;
    editor.begin();
    editor.open(uri, "rifs leaf {\n  map a { scal 1/2 }\n}\n");
    editor.work();
    ASSERT_EQ(editor.findings[uri].size(), 1u);
    const Json finding = editor.findings[uri][0];
    EXPECT_EQ(finding["message"],
              "expected a transform, 'tint', 'material', 'probability', 'terminal' or '}', found "
              "'scal'\nhint: did you mean 'scale'?");
    EXPECT_EQ(finding["severity"], 1);
    EXPECT_EQ(finding["range"],
              Json::parse(R"({"start":{"line":1,"character":10},"end":{"line":1,"character":14}})"));
    // It is mended, and then does not contract.
    editor.tell(
        "textDocument/didChange",
        {{"textDocument", {{"uri", uri}, {"version", 2}}},
         {"contentChanges",
          {{{"range", finding["range"]}, {"text", "scale"}},
           {{"range", Json::parse(R"({"start":{"line":1,"character":16},"end":{"line":1,"character":19}})")},
            {"text", "2"}}}}});
    editor.work();
    ASSERT_EQ(editor.findings[uri].size(), 1u);
    EXPECT_NE(editor.findings[uri][0]["message"].get<std::string>().find("does not contract"),
              std::string::npos);
    editor.tell("textDocument/didClose", {{"textDocument", {{"uri", uri}}}});
    EXPECT_EQ(editor.findings[uri], Json::array());
    EXPECT_FALSE(editor.server().has_work());
}

TEST(LanguageServer, ModelsFollowThoseThatTheyUse) {
    Editor editor;
    editor.begin();
    const std::string part = "file:///nowhere/part.inst", whole = "file:///nowhere/whole.inst";
    editor.open(whole, "use part = \"part.inst\"\nobject m { part }\n");
    editor.work();
    ASSERT_EQ(editor.findings[whole].size(), 1u);
    editor.open(part, "object p { cube }\n");
    editor.work();
    EXPECT_EQ(editor.findings[whole], Json::array());
    editor.tell("textDocument/didChange",
                {{"textDocument", {{"uri", part}}}, {"contentChanges", {{{"text", "object p { cub }\n"}}}}});
    editor.work();
    ASSERT_EQ(editor.findings[whole].size(), 1u); // where the text asks for it
    EXPECT_EQ(editor.findings[whole][0]["range"]["start"]["line"], 0);
    EXPECT_TRUE(
        editor.findings[whole][0]["message"].get<std::string>().starts_with("/nowhere/part.inst:1:12: "))
        << editor.findings[whole][0].dump();
}

TEST(LanguageServer, AModelWithAFaultInWhatItUsesIsNotShownAsItWas) {
    Editor editor;
    editor.begin();
    const std::string part = "file:///nowhere/part.inst", whole = "file:///nowhere/whole.inst";
    editor.open(part, "object p { cube }\n");
    editor.open(whole, "use part = \"part.inst\"\nobject m { part, part translate: 1, 0, 0 }\n");
    editor.work();
    const Json before = editor.result("textDocument/hover", at(whole, 1, 7));
    editor.tell("textDocument/didChange",
                {{"textDocument", {{"uri", part}}}, {"contentChanges", {{{"text", "object p { cub }\n"}}}}});
    editor.work();
    EXPECT_NE(editor.result("textDocument/hover", at(whole, 1, 7)), before);
}

TEST(LanguageServer, NewEditsEndOldWork) {
    Editor editor;
    editor.begin();
    editor.open("file:///nowhere/m.lsys",
                "lsys m {\n  steps 40\n  axiom A(1)\n  A(x) : x > 0 -> F(x)[+A(x*0.83)]A(x*0.79)\n}\n");
    const std::size_t before = editor.published;
    editor.server().work(CancelFlag([] { return true; }));
    EXPECT_EQ(editor.published, before);
    EXPECT_TRUE(editor.server().has_work()); // it is looked at again
}

/// One scene in three: the parsers, the layout and `check` look at all of them elsewhere.
TEST(LanguageServer, LooksAtScenes) {
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(GRAFTAL_SOURCE_DIR "/scenes"))
        if (const auto ending = entry.path().extension();
            ending == ".lsys" || ending == ".rifs" || ending == ".inst")
            paths.push_back(entry.path().string());
    std::ranges::sort(paths);
    ASSERT_GT(paths.size(), 300u);
    for (std::size_t i = 0; 3 * i < paths.size(); ++i)
        paths[i] = paths[3 * i];
    paths.resize(paths.size() / 3);
    const CounterRandom random(5);
    std::uint64_t n = 0;
    std::size_t items = 0, hovers = 0, looked = 0;
    for (const std::string& path : paths) {
        std::ifstream file(path);
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        const std::string uri = uri_of_path(path);
        Editor editor;
        editor.begin();
        editor.open(uri, text);
        const auto lines = static_cast<std::uint64_t>(std::ranges::count(text, '\n')) + 1;
        for (int i = 0; i < 3; ++i) {
            const auto line = static_cast<int>(random(n++) % lines);
            const auto character = static_cast<int>(random(n++) % 60);
            const Json place = at(uri, line, character);
            items += editor.result("textDocument/completion", place)["items"].size();
            hovers += editor.result("textDocument/hover", place).is_null() ? 0 : 1;
            editor.result("textDocument/definition", place);
            editor.result("textDocument/prepareRename", place);
        }
        EXPECT_FALSE(editor.result("textDocument/documentSymbol", {{"textDocument", {{"uri", uri}}}}).empty())
            << path;
        editor.result("textDocument/formatting", {{"textDocument", {{"uri", uri}}}});
        if (text.size() > 1200) continue; // the others are looked at by `check` elsewhere
        editor.work();
        for (const Json& finding : editor.findings[uri])
            EXPECT_NE(finding["severity"], 1) << path << finding.dump();
        ++looked;
    }
    EXPECT_GT(items, 150u);
    EXPECT_GT(hovers, 40u);
    EXPECT_GT(looked, 15u);
}

TEST(LanguageServer, TakesAnyMessage) {
    const CounterRandom random(9);
    std::uint64_t n = 0;
    const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random(n++) % count); };
    const std::string methods[] = {"initialize",
                                   "textDocument/didOpen",
                                   "textDocument/didChange",
                                   "textDocument/hover",
                                   "textDocument/completion",
                                   "textDocument/definition",
                                   "textDocument/rename",
                                   "textDocument/prepareRename",
                                   "textDocument/formatting",
                                   "textDocument/documentSymbol",
                                   "textDocument/didClose",
                                   "nobody/knows",
                                   "$/cancelRequest"};
    Editor editor;
    editor.begin();
    editor.open(uri, leaf);
    const Json odd[] = {nullptr, -1, 1e300, "x", Json::array({1, 2}), Json::object(), true, 4294967296, uri};
    for (int i = 0; i < 10'000; ++i) {
        Json message = {{"jsonrpc", "2.0"},
                        {"method", methods[below(std::size(methods))]},
                        {"params", at(uri, static_cast<int>(below(9)), static_cast<int>(below(50)))}};
        if (below(2)) message["id"] = i + 1000;
        message["params"]["newName"] = below(2) ? Json("b") : odd[below(std::size(odd))];
        message["params"]["contentChanges"] = Json::array({{{"text", leaf.substr(0, below(leaf.size()))}}});
        if (below(3) == 0) message["params"]["contentChanges"][0]["range"] = odd[below(std::size(odd))];
        if (below(4) == 0) message["params"]["textDocument"]["text"] = odd[below(std::size(odd))];
        if (below(4) == 0) message["params"]["position"]["line"] = odd[below(std::size(odd))];
        if (below(8) == 0) message["params"] = odd[below(std::size(odd))];
        if (below(16) == 0) message["method"] = odd[below(std::size(odd))];
        std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
        if (below(4) == 0) text[below(text.size())] = static_cast<char>(below(256));
        if (below(8) == 0) text.resize(below(text.size()));
        editor.send_text(text);
        EXPECT_FALSE(editor.server().ended());
    }
    editor.send_text(std::string(100'000, '['));
    editor.send_text("");
    editor.open(uri, leaf);
    EXPECT_FALSE(editor.result("textDocument/hover", at(uri, 3, 12)).is_null()); // it still serves
}

TEST(MessageStream, CutsAnyStream) {
    MessageStream stream;
    stream.add("Content-Length: 2\r\nContent-Type: x\r\n\r\n{}content-len");
    EXPECT_EQ(stream.next(), "{}");
    EXPECT_EQ(stream.next(), std::nullopt);
    stream.add("gth: 3\r\n\r\nab");
    EXPECT_EQ(stream.next(), std::nullopt);
    stream.add("c" + framed("d"));
    EXPECT_EQ(stream.next(), "abc");
    EXPECT_EQ(stream.next(), "d");
    for (const char* wrong : {"Content-Length: -1\r\n\r\n", "Content-Length: 99999999999\r\n\r\n",
                              "Hello\r\n\r\n", "Content-Length: x\r\n\r\n"}) {
        MessageStream faulty;
        faulty.add(wrong);
        EXPECT_EQ(faulty.next(), std::nullopt);
        EXPECT_NE(faulty.fault(), "") << wrong;
    }
    MessageStream endless;
    endless.add(std::string(5000, 'x'));
    EXPECT_EQ(endless.next(), std::nullopt);
    EXPECT_NE(endless.fault(), "");
}

TEST(Uri, PathsAndBack) {
    EXPECT_EQ(path_of_uri("file:///a%20b/c.rifs"), "/a b/c.rifs");
    EXPECT_EQ(path_of_uri("file://machine/a/../b.rifs"), "/b.rifs");
    EXPECT_EQ(path_of_uri("untitled:Untitled-1.lsys"), "untitled:Untitled-1.lsys");
    EXPECT_EQ(path_of_uri("file:///a%2"), "/a%2");
    EXPECT_EQ(path_of_uri("file:///a%zz%"), "/a%zz%");
    EXPECT_EQ(uri_of_path("/a b/\xC3\xA9.rifs"), "file:///a%20b/%C3%A9.rifs");
}

} // namespace
} // namespace graftal
