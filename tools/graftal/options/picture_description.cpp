#include "tools/graftal/options/picture_description.h"

#include <filesystem>
#include <set>
#include <vector>

#include "compiler/support/printable.h"
#include "compiler/support/shell_words.h"

namespace graftal {

std::string picture_description(const CLI::App& command, const Engine& engine) {
    static const std::set<std::string> unseen = {
        "--output",     "--keep-frames", "--time",       "--quiet", "--keep",        "--card",
        "--dump-after", "--threads",     "--engine",     "--json",  "--progressive", "--no-progressive",
        "--help",       "--root",        "--unconfined", "--watch"};
    std::vector<std::string> words = {"graftal", command.get_name()};
    for (const CLI::Option* const option : command.get_options())
        if (option->get_positional())
            for (const std::string& operand : option->results())
                words.push_back(std::filesystem::path(operand).filename().string());
    if (&engine != &engines().front()) // which may be named or not
        words.insert(words.end(), {"--engine", std::string(engine.name)});
    for (const CLI::Option* const option : command.get_options()) {
        if (option->count() == 0 || option->get_positional() || unseen.contains(option->get_name())) continue;
        const bool flag = option->get_items_expected_max() == 0;
        if (flag) words.push_back(option->get_name());
        // An option that may be given once has the last of its values; --set and --camera have all.
        const bool last = option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeLast;
        const std::vector<std::string> values = flag ? std::vector<std::string>() : option->results();
        for (std::size_t i = last && !values.empty() ? values.size() - 1 : 0; i < values.size(); ++i) {
            words.push_back(option->get_name());
            words.push_back(values[i]);
        }
    }
    const std::string text = shell_quoted(words);
    return escaped(text, text.size());
}

} // namespace graftal
