#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/graftal/help/usage_errors.h"
#include "tools/graftal/options.h"

namespace graftal {

/// "Model file (.lsys, .rifs, .inst, ...)", for help.
std::string model_file_help(const std::string& more = "");

/// Adds an option whose text `read` turns into a value; what it refuses is a usage error saying `expected`.
template<typename Read, typename Store>
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& value_name,
                       const std::string& help, const std::string& expected, Read read, Store store) {
    const auto apply = [=](const std::string& text) {
        auto value = read(text);
        if (!value) throw CLI::ValidationError(fmt::format("{}: '{}' is not {}", name, text, expected));
        store(std::move(*value));
    };
    return app.add_option_function<std::string>(name, apply, help)->type_name(value_name)->take_last();
}

/// Words of an option, each with its value.
template<typename Value> using Choices = std::vector<std::pair<std::string, Value>>;

/// Adds an option that takes one of a few words; another is a usage error that lists them.
template<typename Value, typename Store>
CLI::Option* add_choice(CLI::App& app, const std::string& name, const std::string& help,
                        const Choices<Value>& choices, Store store) {
    std::vector<std::string> words;
    for (const auto& [word, value] : choices)
        words.push_back(word);
    const auto apply = [=](const std::string& text) {
        const auto found = std::ranges::find(words, text);
        if (found == words.end()) throw CLI::ValidationError(unknown_word(name, text, words));
        store(choices[static_cast<std::size_t>(found - words.begin())].second);
    };
    return app.add_option_function<std::string>(name, apply, help)
        ->type_name(fmt::format("{}", fmt::join(words, "|")))
        ->take_last();
}

/// Adds an option for a number of bytes, which `store` gets.
void add_bytes(CLI::App& app, const std::string& name, const std::string& help,
               const std::function<void(std::uint64_t)>& store);

/// A pass of the pipeline, or "all" if that is allowed; else a usage error.
std::optional<std::string> pass_named(const std::string& text, bool all_allowed);

/// The file of the model.
void add_model(CLI::App& app, Options& options);
/// The seed of random numbers.
void add_seed(CLI::App& app, Options& options);
/// Options of every command that reads a model.
void add_common(CLI::App& app, Options& options);
/// Options of commands that look at the model from a camera.
void add_camera(CLI::App& app, Options& options);
/// Options for the parts of the model that are left out for their size.
void add_error(CLI::App& app, Options& options);
/// The light of models that name none.
void add_plain_light(CLI::App& app, Options& options);
/// The limit of the work.
void add_work(CLI::App& app, Options& options, const std::string& help);
/// The limit of the work for commands that only tell of the model.
void add_inspecting_work(CLI::App& app, Options& options);
/// Options of add_camera(), and those for how much of the model is drawn.
void add_view(CLI::App& app, Options& options);
/// The light on a plant's organs.
void add_irradiance(CLI::App& app, Options& options);
/// `--bits`, of a PNG for people.
void add_bits(CLI::App& app, Options& options);
/// `--engine`, one of these names.
void add_engine(CLI::App& app, Options& options, const std::string& help,
                const std::vector<std::string_view>& names);
/// `--device`, of one graphics card.
void add_device(CLI::App& app, Options& options);
/// Options of commands that make pictures.
void add_drawing(CLI::App& app, Options& options);

/// The problem with an output that is a folder, or "". `import` writes into a folder, and `animate` writes
/// one; other outputs are files.
std::string refusal_of_folder(Options& options);

/// The problem with the name of something that the command writes, or "". Names go into files of many
/// formats and to terminals: a line end in one would be a line of its own there.
std::string refusal_of_names(const Options& options);

} // namespace graftal
