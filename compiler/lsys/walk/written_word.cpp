#include "compiler/lsys/walk/written_word.h"

#include <cctype>
#include <string_view>

#include "compiler/lsys/derive/deriver.h"
#include "compiler/lsys/derive/word.h"
#include "compiler/lsys/walk/queries.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool is_long_name(std::string_view symbol) {
    const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    return symbol.size() > 1 && in_name(symbol.back());
}

} // namespace

void WrittenWord::add(SymbolId symbol, std::span<const double> parameters) {
    const std::string& name = grammar_.symbols[symbol];
    const bool apart = is_long_name(name) && !text_.empty() && text_.back() != ' ';
    if (apart) text_ += ' ';
    text_ += name;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        text_ += (i == 0 ? "(" : ",") + shortest(parameters[i]);
    if (!parameters.empty())
        text_ += ')';
    else if (is_long_name(name))
        text_ += ' ';
}

bool WrittenWord::begins(const Module& module, const Turtle&) {
    add(module.symbol, module.parameters);
    return ++count_ <= most_modules_ || refuse_length(grammar_, most_modules_, 0, diagnostics_);
}

std::optional<std::string> derived_word(LsysRewriter& rewriter, unsigned steps, std::uint64_t seed,
                                        std::uint64_t max_modules, Diagnostics& diagnostics) {
    const LsysGrammar& grammar = rewriter.grammar();
    if (!rewriter.prepare(steps)) return std::nullopt;
    LsysQueries queries(rewriter, diagnostics, seed);
    LsysDeriver deriver(rewriter, diagnostics, seed, max_modules);
    if (grammar.has_queries())
        deriver.after_each_step(
            [&](std::uint32_t step, ModuleString& word) { return queries.answer(step, word); });
    const std::optional<ModuleString> word = deriver.derive(steps);
    if (!word) return std::nullopt;
    WrittenWord written(grammar, max_modules, diagnostics);
    for (const ModuleId id : *word)
        written.add(rewriter.modules().symbol(id), rewriter.modules().parameters(id));
    return std::move(written).take();
}

} // namespace graftal
