#include "compiler/lsys/walk/written_word.h"

#include <cctype>
#include <string_view>

#include "compiler/lsys/derive/deriver.h"
#include "compiler/lsys/walk/queries.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool is_long_name(std::string_view symbol) {
    const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    return symbol.size() > 1 && in_name(symbol.back());
}

void append_module(const LsysGrammar& grammar, const ModuleTable& modules, ModuleId id, std::string& text) {
    const std::string& symbol = grammar.symbols[modules.symbol(id)];
    const bool apart = is_long_name(symbol) && !text.empty() && text.back() != ' ';
    if (apart) text += ' ';
    text += symbol;
    const std::span<const double> parameters = modules.parameters(id);
    for (std::size_t i = 0; i < parameters.size(); ++i)
        text += (i == 0 ? "(" : ",") + shortest(parameters[i]);
    if (!parameters.empty())
        text += ')';
    else if (is_long_name(symbol))
        text += ' ';
}

} // namespace

std::optional<ModuleString> derived_word(LsysRewriter& rewriter, unsigned steps, std::uint64_t seed,
                                         std::uint64_t max_modules, Diagnostics& diagnostics) {
    if (!rewriter.prepare(steps)) return std::nullopt;
    LsysQueries queries(rewriter, diagnostics, seed);
    LsysDeriver deriver(rewriter, diagnostics, seed, max_modules);
    if (rewriter.grammar().has_queries())
        deriver.after_each_step(
            [&](std::uint32_t step, ModuleString& word) { return queries.answer(step, word); });
    return deriver.derive(steps);
}

std::string written_word(const DerivedWord& derived) {
    std::string text;
    for (const ModuleId id : derived.word)
        append_module(derived.rewriter.grammar(), derived.rewriter.modules(), id, text);
    return text;
}

} // namespace graftal
