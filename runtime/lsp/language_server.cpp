#include "runtime/lsp/language_server.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/editing/complete.h"
#include "compiler/editing/format.h"
#include "compiler/editing/hover.h"
#include "compiler/editing/names/names.h"
#include "compiler/editing/positions.h"
#include "compiler/editing/rename.h"
#include "compiler/support/path_text.h"
#include "compiler/support/text_encoding.h"
#include "runtime/lsp/uri.h"

namespace graftal {

namespace {

using Json = nlohmann::json;

/// Work for a look at one text, in seconds of one processor.
constexpr double look_seconds = 5;
constexpr int most_levels = 64;

enum Fault : int {
    parse_error = -32700,
    invalid_request = -32600,
    unknown_method = -32601,
    invalid_parameters = -32602,
    internal_error = -32603,
    not_initialised = -32002,
    request_failed = -32803,
};

/// Ends the answer to a request with an error.
struct Refusal {
    int code;
    std::string text;
};

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json range_of(const TextPositions& positions, std::uint32_t begin, std::uint32_t end) {
    const auto place = [&](std::uint32_t byte) {
        const LinePosition at = positions.line_position(byte);
        return Json{{"line", at.line}, {"character", at.character}};
    };
    return {{"start", place(begin)}, {"end", place(end)}};
}

Json range_of(const TextPositions& positions, Span span) {
    return range_of(positions, span.begin, span.end);
}

std::optional<LinePosition> position_of(const Json& json) {
    const auto number = [&](const char* key) -> std::optional<std::uint32_t> {
        const auto found = json.find(key);
        if (found == json.end() || !found->is_number_integer()) return std::nullopt;
        const auto value = found->get<std::int64_t>();
        return value >= 0 && value <= INT32_MAX ? std::optional(static_cast<std::uint32_t>(value))
                                                : std::nullopt;
    };
    if (!json.is_object()) return std::nullopt;
    const auto line = number("line"), character = number("character");
    if (!line || !character) return std::nullopt;
    return LinePosition{*line, *character};
}

const Json& part_of(const Json& json, const char* key) {
    static const Json none;
    if (!json.is_object()) return none;
    const auto found = json.find(key);
    return found == json.end() ? none : *found;
}

std::string string_in(const Json& json, const char* key) {
    const Json& value = part_of(json, key);
    if (!value.is_string()) throw Refusal{invalid_parameters, fmt::format("'{}' must be a text", key)};
    return value.get<std::string>();
}

/// Numbers that the protocol gives to kinds of completions and of symbols.
int completion_kind(std::string_view kind) {
    if (kind == "keyword") return 14;
    if (kind == "function" || kind == "table") return 3;
    if (kind == "primitive" || kind == "object" || kind == "used model" || kind == "block") return 7;
    if (kind == "symbol" || kind == "module" || kind == "map") return 12;
    if (kind == "material") return 16;
    return 6; // a variable
}

std::optional<int> symbol_kind(NameKind kind) {
    switch (kind) {
    case NameKind::let:
    case NameKind::inner:
        return 14;
    case NameKind::variable:
        return 13;
    case NameKind::table:
    case NameKind::function:
        return 12;
    case NameKind::module:
    case NameKind::map:
        return 6;
    case NameKind::material:
        return 7;
    case NameKind::block:
    case NameKind::object:
        return 5;
    case NameKind::model:
        return 2;
    default:
        return std::nullopt;
    }
}

} // namespace

struct LanguageServer::OpenText {
    OpenText(std::string uri_, std::string path_, std::string text, const Files& files)
        : uri(std::move(uri_)), path(std::move(path_)), document(path, std::move(text)),
          session(path, Keep::for_views, files) {}

    void change(std::string text) {
        document = Document(path, std::move(text));
        model.reset();
    }

    std::string uri;
    std::string path; ///< the file, or a name with an ending that tells the language
    std::int64_t version = 0;
    Document document;
    PictureSession session;
    std::shared_ptr<const AnalysedModel>
        model; ///< of the text as it is now; null: not looked at, or with errors
    bool to_look_at = true;
};

/// The methods of the protocol.
class LanguageServer::Handlers {
  public:
    explicit Handlers(LanguageServer& server) : server_(server) {}

    Json answer(const std::string& method, const Json& parameters) {
        if (method == "initialize") return initialize();
        if (!server_.initialised_) throw Refusal{not_initialised, "the server is not initialised"};
        if (server_.shut_down_) throw Refusal{invalid_request, "the server is shut down"};
        if (method == "shutdown") {
            server_.shut_down_ = true;
            return nullptr;
        }
        if (method == "textDocument/completion") return completions(parameters);
        if (method == "textDocument/hover") return hovered(parameters);
        if (method == "textDocument/definition") return defined(parameters);
        if (method == "textDocument/prepareRename") return rename_range(parameters);
        if (method == "textDocument/rename") return renamed(parameters);
        if (method == "textDocument/formatting") return formatted(parameters);
        if (method == "textDocument/documentSymbol") return symbols(parameters);
        throw Refusal{unknown_method, fmt::format("there is no method '{}'", method)};
    }

    void hear(const std::string& method, const Json& parameters) {
        if (method == "exit") server_.ended_ = true;
        if (!server_.initialised_ || server_.shut_down_) return;
        if (method == "textDocument/didOpen") open(part_of(parameters, "textDocument"));
        if (method == "textDocument/didChange") change(parameters);
        if (method == "textDocument/didClose") close(parameters);
        if (method == "textDocument/didSave" || method == "workspace/didChangeWatchedFiles") look_again();
    }

    void publish(const OpenText& text, const Compilation& compilation) {
        const TextPositions positions(text.document.text());
        Json list = Json::array();
        for (const Diagnostic& finding : compilation.diagnostics.all())
            list.push_back(diagnostic(text, finding, compilation.sources, positions));
        notify("textDocument/publishDiagnostics",
               {{"uri", text.uri}, {"version", text.version}, {"diagnostics", std::move(list)}});
    }

    void notify(const char* method, Json parameters) {
        server_.send_(dumped({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}}));
    }

  private:
    Json initialize() {
        server_.initialised_ = true;
        return {{"capabilities",
                 {{"positionEncoding", "utf-16"},
                  {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
                  {"completionProvider", {{"triggerCharacters", {"@", "~", "?"}}}},
                  {"hoverProvider", true},
                  {"definitionProvider", true},
                  {"renameProvider", {{"prepareProvider", true}}},
                  {"documentFormattingProvider", true},
                  {"documentSymbolProvider", true}}},
                {"serverInfo", {{"name", "graftal"}}}};
    }

    OpenText& text_of(const Json& parameters) {
        const std::string uri = string_in(part_of(parameters, "textDocument"), "uri");
        const auto found = server_.texts_.find(uri);
        if (found == server_.texts_.end())
            throw Refusal{invalid_parameters, fmt::format("'{}' is not open", uri)};
        return *found->second;
    }

    static std::uint32_t offset_in(const TextPositions& positions, const Json& parameters) {
        const std::optional<LinePosition> position = position_of(part_of(parameters, "position"));
        if (!position) throw Refusal{invalid_parameters, "'position' must have a line and a character"};
        return positions.byte_of(*position);
    }

    // Texts

    void open(const Json& item) {
        const std::string uri = string_in(item, "uri");
        std::string text = checked(string_in(item, "text"));
        if (!server_.texts_.contains(uri) && server_.texts_.size() >= most_texts)
            return complain(fmt::format("graftal looks at {} open models at most", most_texts));
        std::string path = path_of_uri(uri);
        const Json& language = part_of(item, "languageId");
        // An editor may call a new text by a name without an ending.
        if (extension_of(path).empty() && language.is_string()) path += "." + language.get<std::string>();
        auto opened = std::make_unique<OpenText>(uri, path, std::move(text), server_.files_);
        take(*opened, item);
        server_.texts_[uri] = std::move(opened);
    }

    void take(OpenText& text, const Json& item) {
        const Json& version = part_of(item, "version");
        text.version = version.is_number_integer() ? version.get<std::int64_t>() : 0;
        text.session.edit(std::string(text.document.text()));
        server_.files_.set(text.path, std::string(text.document.text()));
        look_again();
    }

    /// Models that use the one that changed have changed, too.
    void look_again() {
        for (const auto& [uri, text] : server_.texts_) {
            text->session.reload();
            text->to_look_at = true;
        }
    }

    static std::string checked(std::string text) {
        if (text.size() > most_text_bytes)
            throw Refusal{invalid_parameters,
                          fmt::format("a text has more than {} MiB", most_text_bytes >> 20)};
        return decoded_text(std::move(text), OtherBytes::kept);
    }

    void change(const Json& parameters) {
        OpenText& text = text_of(parameters);
        const Json& changes = part_of(parameters, "contentChanges");
        if (!changes.is_array()) return;
        std::string now(text.document.text());
        for (const Json& one : changes) {
            const std::string put = string_in(one, "text");
            const Json& range = part_of(one, "range");
            if (range.is_null()) {
                now = checked(put);
                continue;
            }
            const TextPositions positions(now);
            const auto start = position_of(part_of(range, "start")), end = position_of(part_of(range, "end"));
            if (!start || !end) throw Refusal{invalid_parameters, "a range must have a start and an end"};
            const std::uint32_t begin = positions.byte_of(*start);
            now.replace(begin, std::max(positions.byte_of(*end), begin) - begin, put);
            now = checked(std::move(now));
        }
        text.change(std::move(now));
        take(text, part_of(parameters, "textDocument"));
    }

    void close(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const std::string uri = text.uri;
        server_.files_.remove(text.path);
        notify("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}});
        server_.texts_.erase(uri);
        look_again();
    }

    void complain(const std::string& text) { notify("window/logMessage", {{"type", 2}, {"message", text}}); }

    // Findings

    Json diagnostic(const OpenText& text, const Diagnostic& finding, const SourceMap& sources,
                    const TextPositions& positions) const {
        std::string message = finding.message;
        Span span = finding.span;
        if (span.known() && span.file != 0) { // of a model that is used
            const Position at = sources.position(span.file, span.begin);
            message = fmt::format("{}:{}:{}: {}", sources.name(span.file), at.line, at.column, message);
            span = use_of(text, sources.name(span.file));
        }
        if (!span.known()) span = {0, 0, 0};
        if (!finding.hint.empty()) message += "\nhint: " + finding.hint;
        Json related = Json::array();
        for (const Note& note : finding.notes)
            if (note.span.known() && note.span.file == 0)
                related.push_back(
                    {{"location", {{"uri", text.uri}, {"range", range_of(positions, note.span)}}},
                     {"message", note.message}});
        const int severity = finding.severity == Severity::error     ? 1
                             : finding.severity == Severity::warning ? 2
                                                                     : 3;
        return {{"range", range_of(positions, span)},
                {"severity", severity},
                {"source", "graftal"},
                {"message", message},
                {"relatedInformation", std::move(related)}};
    }

    /// The statement that asks for a file.
    static Span use_of(const OpenText& text, std::string_view file) {
        for (const NamedThing& thing : names_of(text.document))
            if (thing.kind == NameKind::model && !thing.definitions.empty())
                if (const auto place = definition(text.document, thing.whole.end);
                    place && place->file == file)
                    return thing.whole;
        return {};
    }

    // Questions

    Json completions(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        const std::uint32_t offset = offset_in(positions, parameters);
        const Completions found = complete(text.document, offset);
        const Json range = range_of(positions, found.from, offset);
        Json items = Json::array();
        for (const Completion& item : found.items)
            items.push_back({{"label", item.label},
                             {"kind", completion_kind(item.kind)},
                             {"detail", item.detail},
                             {"sortText", fmt::format("{:04}", items.size())},
                             {"textEdit", {{"range", range}, {"newText", item.text}}}});
        return {{"isIncomplete", false}, {"items", std::move(items)}};
    }

    Json hovered(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        const auto found = hover(text.document, offset_in(positions, parameters), text.model.get());
        if (!found) return nullptr;
        return {{"contents", {{"kind", "markdown"}, {"value", found->text}}},
                {"range", range_of(positions, found->span)}};
    }

    Json defined(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        const auto found = definition(text.document, offset_in(positions, parameters));
        if (!found) return nullptr;
        const bool here = found->file == text.document.name();
        const TextPositions nowhere("");
        return {{"uri", here ? text.uri : uri_of_path(found->file)},
                {"range", range_of(here ? positions : nowhere, found->span)}};
    }

    Json rename_range(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        const Span span = renamable(text.document, offset_in(positions, parameters));
        return span.known() ? range_of(positions, span) : Json(nullptr);
    }

    static Json edits_of(const TextPositions& positions, const std::vector<TextEdit>& edits) {
        Json list = Json::array();
        for (const TextEdit& edit : edits)
            list.push_back({{"range", range_of(positions, edit.begin, edit.end)}, {"newText", edit.text}});
        return list;
    }

    Json renamed(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        const Renaming result =
            rename(text.document, offset_in(positions, parameters), string_in(parameters, "newName"));
        if (!result.refusal.empty()) throw Refusal{request_failed, result.refusal};
        return {{"changes", {{text.uri, edits_of(positions, result.edits)}}}};
    }

    Json formatted(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        return edits_of(TextPositions(text.document.text()), format(text.document));
    }

    Json symbols(const Json& parameters) {
        const OpenText& text = text_of(parameters);
        const TextPositions positions(text.document.text());
        Json list = Json::array();
        for (const NamedThing& thing : names_of(text.document)) {
            const std::optional<int> kind = symbol_kind(thing.kind);
            if (!kind || thing.definitions.empty()) continue;
            const Span name = thing.definitions.front();
            list.push_back({{"name", thing.name},
                            {"detail", word_of(thing.kind)},
                            {"kind", *kind},
                            {"range", range_of(positions, join(thing.whole, name))},
                            {"selectionRange", range_of(positions, name)}});
        }
        return list;
    }

    LanguageServer& server_;
};

LanguageServer::LanguageServer(const Files& files, Send send) : files_(&files), send_(std::move(send)) {}
LanguageServer::~LanguageServer() = default;

void LanguageServer::receive(const std::string& message) {
    const auto depth_is_sane = [](int depth, Json::parse_event_t, Json&) {
        if (depth > most_levels) throw Refusal{parse_error, "the message is nested too deeply"};
        return true;
    };
    Json id;
    const auto refuse = [&](int code, const std::string& text) {
        send_(dumped({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}}));
    };
    bool asked = true;
    try {
        const Json json = Json::parse(message, depth_is_sane);
        const Json& number = part_of(json, "id");
        asked = number.is_number_integer() || number.is_string();
        if (asked) id = number;
        const Json& method = part_of(json, "method");
        if (!method.is_string()) {
            // An answer to a question: the server asks none.
            if (json.is_object() && (json.contains("result") || json.contains("error"))) return;
            asked = true;
            throw Refusal{invalid_request, "a message must have a method"};
        }
        if (asked)
            send_(dumped(
                {{"jsonrpc", "2.0"},
                 {"id", id},
                 {"result", Handlers(*this).answer(method.get<std::string>(), part_of(json, "params"))}}));
        else
            Handlers(*this).hear(method.get<std::string>(), part_of(json, "params"));
    } catch (const Refusal& refusal) {
        if (asked) refuse(refusal.code, refusal.text);
    } catch (const Json::exception& fault) {
        refuse(parse_error, fault.what());
    } catch (const std::exception& fault) {
        if (asked) refuse(internal_error, fault.what());
    }
}

bool LanguageServer::has_work() const {
    return std::ranges::any_of(texts_, [](const auto& text) { return text.second->to_look_at; });
}

void LanguageServer::work(const CancelFlag& cancel) {
    const auto found = std::ranges::find_if(texts_, [](const auto& text) { return text.second->to_look_at; });
    if (found == texts_.end()) return;
    OpenText& text = *found->second;
    Compilation compilation;
    std::shared_ptr<const AnalysedModel> model;
    try {
        StageOptions options;
        options.lower.may_be_orbit = true;
        options.lower.may_leave_out_colours = true;
        options.detail.work_seconds = look_seconds;
        options.draws = false;
        text.session.set_control({cancel, {}});
        const auto lowered = text.session.lowered(options, compilation);
        if (lowered && !lowered->notes.orbit) {
            compilation = Compilation();
            model = text.session.analysed(options, compilation);
        }
        if (cancel.raised()) return;
    } catch (const std::exception& fault) {
        compilation.diagnostics.error(Span{0, 0, 0}, fault.what());
    }
    text.to_look_at = false;
    text.model = std::move(model);
    if (!compilation.status.ok()) compilation.diagnostics.error(Span{0, 0, 0}, compilation.status.message());
    Handlers(*this).publish(text, compilation);
}

} // namespace graftal
