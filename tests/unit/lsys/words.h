#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/derive/deriver.h"
#include "tests/unit/lsys/texts.h"

namespace graftal::testing {

/// An L-system of these statements, ready to derive.
class LsysModel {
  public:
    /// Of its blocks.
    static constexpr std::uint64_t most_statements = 100'000;

    explicit LsysModel(const std::string& statements) {
        parse("lsys test {\n" + statements + "\n}\n", parsed_);
        if (parsed_.file.blocks.size() != 1) return;
        const LsysBlock& block = parsed_.file.blocks[0];
        Environment lets;
        for (const SceneStatement& statement : block.lets)
            for (const SceneField& field : statement.fields)
                lets[field.keyword] = evaluate(field.values.at(0), lets, parsed_.diagnostics).value_or(0);
        grammar_ = build_grammar(block, lets, parsed_.diagnostics);
        if (grammar_ && !parsed_.diagnostics.has_errors()) rewriter_.emplace(*grammar_, parsed_.diagnostics);
    }

    std::optional<ModuleString> derive(unsigned steps, std::uint64_t seed = 0,
                                       std::uint64_t most = 100'000'000) {
        return derive_by(steps, {}, seed, most);
    }

    /// With a stage between the steps.
    std::optional<ModuleString> derive_by(unsigned steps, LsysStage stage, std::uint64_t seed = 0,
                                          std::uint64_t most = 100'000'000) {
        if (!rewriter_) return std::nullopt;
        if (!grammar_->first_cells.empty())
            rewriter_.emplace(*grammar_, parsed_.diagnostics, seed, nullptr, most_statements);
        LsysDeriver deriver(*rewriter_, parsed_.diagnostics, seed, most);
        deriver.after_each_step(std::move(stage));
        return deriver.derive(steps);
    }

    /// The word as text: `F[+(30)A(1,2)]`.
    std::string text(const ModuleString& word) const {
        std::string out;
        for (const ModuleId module : word) {
            out += symbol(module);
            const auto parameters = rewriter_->modules().parameters(module);
            for (std::size_t i = 0; i < parameters.size(); ++i)
                out += fmt::format("{}{}", i == 0 ? "(" : ",", parameters[i]);
            if (!parameters.empty()) out += ")";
        }
        return out;
    }

    const std::string& symbol(ModuleId module) const {
        return grammar_->symbols[rewriter_->modules().symbol(module)];
    }
    std::size_t distinct_modules() const { return rewriter_->modules().size(); }
    LsysRewriter& rewriter() { return *rewriter_; }
    Diagnostics& diagnostics() { return parsed_.diagnostics; }
    std::string errors() const { return parsed_.diagnostics.render(parsed_.sources); }

  private:
    ParsedLsys parsed_;
    std::optional<LsysGrammar> grammar_;
    std::optional<LsysRewriter> rewriter_;
};

/// The word after some steps as text; or what is wrong.
inline std::string derived(const std::string& statements, unsigned steps, std::uint64_t seed = 0,
                           std::uint64_t most = 100'000'000) {
    LsysModel model(statements);
    const auto word = model.derive(steps, seed, most);
    return word ? model.text(*word) : model.errors();
}

} // namespace graftal::testing
