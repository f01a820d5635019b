#include "tools/graftal/help/documents.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "compiler/languages/languages.h"
#include "runtime/gpu/device.h"
#include "runtime/render/render.h"
#include "tools/graftal/help/completion.h"
#include "tools/graftal/help/manual.h"
#include "tools/graftal/help/usage_errors.h"

namespace graftal {

namespace {

std::vector<std::string> names_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

/// The command that the words name, from `app` down.
const CLI::App& command_named(const CLI::App& app, const std::vector<std::string>& words) {
    const CLI::App* command = &app;
    for (const std::string& word : words) {
        const auto below = command->get_subcommands(
            [&](const CLI::App* candidate) { return candidate->get_name() == word; });
        if (below.empty())
            throw CLI::ValidationError(
                unknown_command(fmt::format("{}", fmt::join(words, " ")), names_of(*command)));
        command = below.front();
    }
    return *command;
}

const CommandTree& tree_named(const CommandTree& tree, const std::vector<std::string>& words) {
    const CommandTree* found = &tree;
    for (const std::string& word : words)
        found = &*std::ranges::find(found->commands, word,
                                    [](const CommandTree& command) { return command.path.back(); });
    return *found;
}

std::string version_as_json(const CommandTree& tree) {
    nlohmann::ordered_json object = {{"name", "graftal"}, {"version", GRAFTAL_VERSION}};
    for (const Engine& engine : engines())
        object["engines"].push_back(engine.name);
    object["devices"] = nlohmann::ordered_json::array();
    for (const GpuInfo& device : gpu_devices())
        object["devices"].push_back({{"name", device.name},
                                     {"software", device.is_processor},
                                     {"memory_bytes", device.memory_bytes}});
    for (const Language& language : languages())
        object["languages"].push_back(language.extension);
    for (const CommandTree* const command : all_commands(tree))
        if (command != &tree)
            object["commands"].push_back(command->name(" ").substr(tree.path.front().size() + 1));
    object["shells"] = completed_shells();
    return object.dump(2) + "\n";
}

} // namespace

std::vector<std::string> Documents::commands() {
    return {"help", "version", "completion", "manual"};
}

Documents::Documents(CLI::App& app) : app_(app) {
    app.add_subcommand("help", "Explain a command")
        ->add_option("COMMAND", command_, "The words of a command (default: all commands)")
        ->type_name("");
    CLI::App* const version = app.add_subcommand("version", "Print the version, and what this program knows");
    version->add_flag("--json", json_, "Print one JSON object on standard output");
    const std::vector<std::string> shells = completed_shells();
    app.add_subcommand("completion", "Print the script by which a shell completes graftal's words")
        ->footer("Examples:\n"
                 "  source <(graftal completion bash)                       # for this shell\n"
                 "  graftal completion fish > ~/.config/fish/completions/graftal.fish")
        ->add_option("SHELL", shell_, fmt::format("The shell: {}", fmt::join(shells, ", ")))
        ->required()
        ->check([shells](const std::string& shell) {
            if (std::ranges::find(shells, shell) == shells.end())
                return unknown_word("SHELL", shell, shells)
                    .substr(std::string("SHELL: ").size()); // the library puts the name before it
            return std::string();
        })
        ->type_name("");
    app.add_subcommand("manual", "Print a page of the manual")
        ->footer("Example:\n  graftal manual render | man -l -")
        ->add_option("COMMAND", command_, "The words of a command (default: the page of graftal itself)")
        ->type_name("");
}

std::optional<std::string> Documents::text() const {
    if (app_.got_subcommand("help")) {
        const CLI::App& command = command_named(app_, command_);
        // CLI::App::help() would explain `graftal help` itself.
        return command.get_formatter()->make_help(
            &command, fmt::format("graftal{}{}", command_.empty() ? "" : " ", fmt::join(command_, " ")),
            CLI::AppFormatMode::Normal);
    }
    const bool is_version = app_.got_subcommand("version"), is_completion = app_.got_subcommand("completion");
    if (is_version && !json_) return "graftal " GRAFTAL_VERSION "\n";
    if (!is_version && !is_completion && !app_.got_subcommand("manual")) return std::nullopt;
    const CommandTree tree = option_tree(app_);
    if (is_version) return version_as_json(tree);
    if (is_completion) return completion_script(shell_, tree);
    command_named(app_, command_);
    return manual_page(tree_named(tree, command_), tree);
}

} // namespace graftal
