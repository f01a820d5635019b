#include "runtime/graftal/messages.h"

#include <fmt/format.h>

#include "runtime/graftal/library_words.h"

namespace graftal::v1 {

namespace {

Severity severity_of(graftal::Severity severity) {
    switch (severity) {
    case graftal::Severity::error:
        return Severity::error;
    case graftal::Severity::warning:
        return Severity::warning;
    case graftal::Severity::note:
        break;
    }
    return Severity::note;
}

Message message_of(const Diagnostic& finding, const SourceMap& sources) {
    Message message{severity_of(finding.severity), {}, 0, 0, in_library_words(finding.message),
                    in_library_words(finding.hint)};
    if (!finding.span.known()) return message;
    const Position at = sources.position(finding.span.file, finding.span.begin);
    message.file = sources.name(finding.span.file);
    message.line = at.line;
    message.column = at.column;
    return message;
}

} // namespace

std::vector<Message> messages_of(const Compilation& compilation) {
    std::vector<Message> messages;
    for (const Diagnostic& finding : compilation.diagnostics.all())
        messages.push_back(message_of(finding, compilation.sources));
    if (!compilation.status.ok())
        messages.push_back({Severity::error, {}, 0, 0, in_library_words(compilation.status.message()), {}});
    return messages;
}

const char* name_of(Severity severity) {
    static constexpr const char* names[] = {"error", "warning", "note"};
    return names[static_cast<std::size_t>(severity)];
}

std::string text_of(const std::vector<Message>& messages) {
    std::string text;
    for (const Message& message : messages) {
        if (!message.file.empty())
            text += fmt::format("{}:{}:{}: ", message.file, message.line, message.column);
        text += fmt::format("{}: {}\n", name_of(message.severity), message.text);
        if (!message.hint.empty()) text += fmt::format("  {}\n", message.hint);
    }
    return text;
}

} // namespace graftal::v1
