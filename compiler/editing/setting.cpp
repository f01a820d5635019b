#include "compiler/editing/setting.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

bool has_chance(const LsysString& word) {
    return std::ranges::any_of(word.modules, [](const LsysModule& module) {
        return std::ranges::any_of(module.parameters, calls_chance);
    });
}

bool has_chance(const std::optional<LsysCommands>& commands);

bool has_chance(const LsysCommand& command) {
    return (command.value && calls_chance(*command.value)) ||
           std::ranges::any_of(command.indices, calls_chance) ||
           std::ranges::any_of(command.arms, [](const LsysCommandArm& arm) {
               return (arm.condition && calls_chance(*arm.condition)) ||
                      std::ranges::any_of(arm.commands,
                                          [](const LsysCommand& inner) { return has_chance(inner); });
           });
}

bool has_chance(const std::optional<LsysCommands>& commands) {
    return commands && std::ranges::any_of(commands->list,
                                           [](const LsysCommand& command) { return has_chance(command); });
}

bool has_chance(const LsysProduction& production) {
    return production.probability || (production.condition && calls_chance(*production.condition)) ||
           has_chance(production.before) || has_chance(production.after) || has_chance(production.successor);
}

bool has_chance(const std::vector<LsysProduction>& productions) {
    return std::ranges::any_of(productions,
                               [](const LsysProduction& production) { return has_chance(production); });
}

bool has_chance(const LsysBlock& block) {
    return has_chance(block.productions) || has_chance(block.interpret) || has_chance(block.decompose) ||
           (block.axiom && has_chance(*block.axiom)) || has_chance(block.start) ||
           has_chance(block.start_each) || has_chance(block.end_each) || has_chance(block.end);
}

/// A line in front of the one at this place, with its indent; in the line, where other words stand before.
TextEdit added_before(std::string_view text, std::uint32_t place, const std::string& statement) {
    const std::size_t line = text.find_last_of('\n', place == 0 ? 0 : place - 1);
    const std::size_t begin = line == std::string_view::npos || place == 0 ? 0 : line + 1;
    const std::string_view indent = text.substr(begin, place - begin);
    const bool is_alone = indent.find_first_not_of(" \t") == std::string_view::npos;
    return {place, place, is_alone ? fmt::format("{}\n{}", statement, indent) : statement + "  "};
}

class SettingText {
  public:
    SettingText(const Document& document, std::uint64_t value)
        : document_(document), number_(fmt::format("{}", value)) {}

    SettingChange steps() {
        if (const LsysFile* const lsys = document_.lsys()) {
            if (const LsysBlock* const block = main_block(*lsys)) steps_of(*block);
        } else if (const RifsFile* const rifs = document_.rifs()) {
            steps_of(rifs->statements);
        } else if (const InstModule* const inst = document_.inst()) {
            steps_of(inst->scene);
        }
        return done("the text is at fault, so graftal does not know where its steps belong");
    }

    SettingChange seed() {
        const LsysFile* const tree = document_.lsys();
        if (!tree)
            return done("only the text of an L-system has a place for the seed: a link keeps it, and so does "
                        "the command line");
        for (const LsysBlock& block : tree->blocks) {
            if (!has_chance(block)) continue;
            if (block.seed)
                replace(block.seed->value.span);
            else
                add(block, "seed");
        }
        if (!tree->uses.empty()) change_.remark = "Models that this one uses keep their own seeds.";
        return done("no rule of this text has chance: a link keeps the seed, and so does the command line");
    }

  private:
    SettingChange done(const char* refusal) {
        if (change_.edits.empty()) change_ = {{}, refusal, {}};
        return std::move(change_);
    }

    void replace(Span span) { change_.edits.push_back({span.begin, span.end, number_}); }

    void add(const LsysBlock& block, std::string_view keyword) {
        if (block.axiom)
            change_.edits.push_back(added_before(document_.text(), block.axiom->span.begin,
                                                 fmt::format("{} {}", keyword, number_)));
    }

    void steps_of(const LsysBlock& block) {
        constexpr std::string_view endless = "infinite";
        if (!block.steps) return add(block, "steps");
        if (block.steps->value) return replace(block.steps->value->span);
        const std::size_t place = document_.text().find(endless, block.steps->span.end);
        const auto begin = static_cast<std::uint32_t>(place);
        if (place != std::string_view::npos)
            replace({0, begin, begin + static_cast<std::uint32_t>(endless.size())});
    }

    void steps_of(const std::vector<SceneStatement>& statements) {
        if (document_.findings().has_errors()) return;
        for (const SceneStatement& statement : statements)
            if (statement.kind == SceneStatement::Kind::steps && !statement.fields.empty() &&
                !statement.fields.front().values.empty())
                return replace(statement.fields.front().values.front().span);
        const std::string_view text = document_.text();
        const auto end = static_cast<std::uint32_t>(text.size());
        change_.edits.push_back(
            {end, end,
             fmt::format("{}steps: {}\n", text.empty() || text.ends_with('\n') ? "" : "\n", number_)});
    }

    const Document& document_;
    const std::string number_;
    SettingChange change_;
};

} // namespace

SettingChange write_setting(const Document& document, ModelSetting setting, std::uint64_t value) {
    SettingText text(document, value);
    return setting == ModelSetting::steps ? text.steps() : text.seed();
}

} // namespace graftal
