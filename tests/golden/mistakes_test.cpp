// Mistakes that people make: tests/golden/mistakes.txt holds hundreds of small models, each with one, and
// what is said about it: one message, at the right place, with a hint that helps. GRAFTAL_REWRITE_EXPECTED=1
// in the environment writes what is said anew: look at the difference before committing it.
//
//     === inst: a misspelt primitive
//     object a { spere }
//     --- says
//     1:12: error: unknown object 'spere'
//         hint: did you mean 'sphere'?
//
// In the text of a model \uXXXX, \r, \t and \\ stand for what one cannot see.

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/support/printable.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"

namespace graftal {
namespace {

const std::string list = GRAFTAL_SOURCE_DIR "/tests/golden/mistakes.txt";

struct Mistake {
    std::string title; ///< "inst: a misspelt primitive"
    std::string text;
    std::string said;
};

std::vector<Mistake> mistakes() {
    std::string text;
    EXPECT_TRUE(read_text(list, text).ok());
    std::vector<Mistake> all;
    std::istringstream lines(text);
    bool says = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("=== ")) {
            all.push_back({line.substr(4), "", ""});
            says = false;
        } else if (line == "--- says") {
            says = true;
        } else if (!all.empty()) {
            (says ? all.back().said : all.back().text) += line + "\n";
        }
    }
    return all;
}

void append_utf8(std::string& out, unsigned c) {
    if (c < 0x80) return out.push_back(static_cast<char>(c));
    if (c >= 0x800) {
        out.push_back(static_cast<char>(0xE0 | c >> 12));
        out.push_back(static_cast<char>(0x80 | (c >> 6 & 0x3F)));
    } else {
        out.push_back(static_cast<char>(0xC0 | c >> 6));
    }
    out.push_back(static_cast<char>(0x80 | (c & 0x3F)));
}

std::string unescaped(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            out += text[i];
        } else if (text[i + 1] == 'u' && i + 5 < text.size()) {
            append_utf8(out, static_cast<unsigned>(std::stoul(text.substr(i + 2, 4), nullptr, 16)));
            i += 5;
        } else {
            const char c = text[++i];
            out += c == 'r' ? '\r' : c == 't' ? '\t' : c;
        }
    }
    return out;
}

/// Places, messages and hints, without the excerpts.
std::string said_about(const std::string& name, const std::string& text, std::size_t& errors) {
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.may_be_orbit = true;
    static_cast<void>(lower_text(name, text, options, sources, diagnostics, {.files = &disk_files()}));
    errors = diagnostics.error_count();
    const auto place = [&](Span span) -> std::string {
        if (!span.known()) return "";
        const Position at = sources.position(span.file, span.begin);
        return fmt::format("{}:{}: ", at.line, at.column);
    };
    std::string out;
    for (const Diagnostic& finding : diagnostics.all()) {
        const char* const severity = finding.severity == Severity::error ? "error" : "warning";
        out += fmt::format("{}{}: {}\n", place(finding.span), severity, escaped(finding.message));
        if (!finding.hint.empty()) out += fmt::format("    hint: {}\n", escaped(finding.hint));
        for (const Note& note : finding.notes)
            out += fmt::format("    note at {}{}\n", place(note.span), escaped(note.message));
    }
    return out;
}

TEST(Mistakes, EachGetsOneMessageThatHelps) {
    std::string rewritten;
    const std::vector<Mistake> all = mistakes();
    ASSERT_GE(all.size(), 300u);
    for (const Mistake& mistake : all) {
        const std::string language = mistake.title.substr(0, mistake.title.find(':'));
        std::size_t errors = 0;
        const std::string said = said_about("m." + language, unescaped(mistake.text), errors);
        rewritten += fmt::format("=== {}\n{}--- says\n{}\n", mistake.title, mistake.text, said);
        if (std::getenv("GRAFTAL_REWRITE_EXPECTED")) continue;
        EXPECT_EQ(said + "\n", mistake.said) << mistake.title << '\n' << mistake.text;
        const bool several = mistake.title.find("mistakes") != std::string::npos; // "two mistakes", and so on
        if (!several) {
            EXPECT_LE(errors, 1u) << mistake.title << '\n' << mistake.text << said;
        }
    }
    if (std::getenv("GRAFTAL_REWRITE_EXPECTED")) {
        ASSERT_TRUE(write_text(list, rewritten).ok());
    }
}

} // namespace
} // namespace graftal
