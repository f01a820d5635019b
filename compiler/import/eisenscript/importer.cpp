#include <cctype>

#include "compiler/import/eisenscript/parser.h"
#include "compiler/import/eisenscript/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"

namespace graftal {

namespace eisenscript {

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel&) {
    const std::size_t errors = file.diagnostics.error_count();
    const Script script = parse(file);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    if (script.rules.front().actions.empty()) {
        file.diagnostics.error(file.span(0, 0),
                               "the script draws nothing: no action stands outside of its rules");
        return std::nullopt;
    }
    Writer writer(file, script);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return writer.write();
}

/// A line begins with an action, as `3 * { x 1 } box`, or sets something that no other language knows.
bool recognises(std::string_view text) {
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        std::string_view words = trimmed(line.text);
        for (const std::string_view setting : {"set maxdepth ", "set maxobjects ", "set background "})
            if (words.starts_with(setting)) return true;
        const std::size_t star = words.find('*');
        if (star != std::string_view::npos &&
            trimmed(words.substr(0, star)).find_first_not_of("0123456789") == std::string_view::npos)
            words = trimmed(words.substr(star + 1));
        const std::size_t close = words.find('}');
        if (!words.starts_with('{') || close == std::string_view::npos) continue;
        const std::string_view behind = trimmed(words.substr(close + 1));
        if (!behind.empty() && (std::isalpha(static_cast<unsigned char>(behind[0])) || behind[0] == '{'))
            return true;
    }
    return false;
}

} // namespace eisenscript

Importer eisenscript_importer() {
    static constexpr std::string_view endings[] = {"es"};
    return {.format = "EisenScript",
            .endings = endings,
            .recognises = eisenscript::recognises,
            .sign = "rules such as 'rule name { { x 1 } box }'",
            .models = one_scene,
            .translation = eisenscript::translate,
            .most_bytes = 1'000'000};
}

} // namespace graftal
