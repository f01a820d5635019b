#include "tools/graftal/help/option_tree.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/passes/pipeline.h"
#include "tools/graftal/help/format.h"

namespace graftal {

namespace {

/// The words of "draft|normal|best". Words in capitals stand for others.
std::vector<std::string> words_of(const std::string& name, const std::string& value) {
    std::vector<std::string> words;
    if (value.find('|') != std::string::npos)
        for (const std::string& word : CLI::detail::split(value, '|'))
            if (std::ranges::none_of(word, [](unsigned char c) { return std::isupper(c); }))
                words.push_back(word);
    if (value == "PASS") {
        for (const Pass& pass : model_passes())
            words.emplace_back(pass.name);
        if (name == "--dump-after") {
            for (const Pass& pass : detail_passes())
                words.emplace_back(pass.name);
            words.emplace_back("all");
        }
    }
    return words;
}

ValueKind kind_of(std::string_view value) {
    if (value == "MODEL") return ValueKind::model;
    if (value == "TARGET" || value == "A B") return ValueKind::picture;
    if (value.starts_with("FILE")) return ValueKind::file;
    if (value == "DIR" || value == "FOLDER" || value == "JOB") return ValueKind::folder;
    return ValueKind::text;
}

OptionEntry entry_of(const CLI::Option& option) {
    OptionEntry entry;
    for (const std::string& name : option.get_snames())
        entry.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        entry.names.push_back("--" + name);
    const bool is_operand = option.get_positional();
    entry.value = is_operand                             ? option.get_name(true)
                  : option.get_items_expected_max() == 0 ? ""
                                                         : option.get_type_name();
    entry.help = option.get_description();
    entry.group = option.get_group();
    entry.kind = kind_of(entry.value);
    entry.words = words_of(option.get_name(), entry.value);
    entry.repeats = option.get_multi_option_policy() != CLI::MultiOptionPolicy::TakeLast &&
                    !entry.value.empty() && option.get_expected_max() > 1;
    return entry;
}

/// The lines of commands below "Examples:", without indentation.
std::string plain_examples(const std::string& examples) {
    std::string lines;
    for (std::string line : CLI::detail::split(examples, '\n')) {
        if (line.starts_with("Example")) line.erase(0, line.find(':') + 1);
        if (!CLI::detail::ltrim(line).empty()) lines += line + "\n";
    }
    return lines;
}

CommandTree tree_below(const CLI::App& app, std::vector<std::string> path) {
    CommandTree tree;
    path.push_back(app.get_name());
    tree.path = path;
    tree.summary = app.get_description();
    const HelpFooter footer = help_footer(app);
    tree.notes = footer.notes;
    tree.examples = plain_examples(footer.examples);
    for (const CLI::Option* const option : app.get_options())
        if (!is_for_tests(*option))
            (option->get_positional() ? tree.operands : tree.options).push_back(entry_of(*option));
    for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
        tree.commands.push_back(tree_below(*command, path));
    return tree;
}

} // namespace

std::string CommandTree::name(const char* separator) const {
    return fmt::format("{}", fmt::join(path, separator));
}

CommandTree option_tree(const CLI::App& app) {
    return tree_below(app, {});
}

std::vector<const CommandTree*> all_commands(const CommandTree& tree) {
    std::vector<const CommandTree*> all = {&tree};
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const CommandTree& command : all[i]->commands)
            all.push_back(&command);
    return all;
}

std::string in_one_line(const std::string& help) {
    std::size_t end = help.size();
    for (const char* const mark : {" (", "; ", ": ", ". "})
        end = std::min(end, help.find(mark));
    return help.substr(0, end);
}

} // namespace graftal
