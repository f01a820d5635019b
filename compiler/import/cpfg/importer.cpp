#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/import/cpfg/names.h"
#include "compiler/import/cpfg/reader.h"
#include "compiler/import/cpfg/source.h"
#include "compiler/import/cpfg/view.h"
#include "compiler/import/cpfg/write/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

/// The files that go with a model; "" for those that it has not.
struct CpfgCompanions {
    std::string view;        ///< view file
    std::string environment; ///< of the environment program
};

bool ends_in(std::string_view word, std::string_view ending) {
    return word.size() > ending.size() && word.ends_with(ending);
}

/// The files that the model's `specifications` name; else the view file has the model's name.
CpfgCompanions find_cpfg_companions(const ForeignFile& file) {
    CpfgCompanions found;
    const std::string_view own = file.sources.name(file.file);
    if (const auto specifications = file.read_beside("specifications")) {
        const std::string_view text = file.sources.text(*specifications);
        for (const TextLine& line : lines_of(text, 0, text.size())) {
            std::istringstream words{std::string(line.text)};
            std::vector<std::string> command;
            for (std::string word; words >> word;)
                command.push_back(word);
            bool names_own = false;
            for (const std::string& word : command)
                names_own = names_own || word == file_name_of(own);
            if (command.empty() || !command[0].starts_with("cpfg") || !names_own) continue;
            for (std::size_t i = 1; i < command.size(); ++i) {
                if (command[i - 1] == "-e") found.environment = command[i];
                if (found.view.empty() && (ends_in(command[i], ".v") || ends_in(command[i], ".view")))
                    found.view = command[i];
            }
            return found;
        }
    }
    for (const char* ending : {".v", ".view"}) {
        const std::string name = std::string(stem_of(own)) + ending;
        if (found.view.empty() && file.read_beside(name)) found.view = name;
    }
    return found;
}

/// A line begins with "Lsystem:".
bool is_cpfg(std::string_view text) {
    return std::ranges::any_of(lines_of(text, 0, text.size()), [](const TextLine& line) {
        const std::string_view words = trimmed(line.text);
        return words.starts_with("Lsystem:") || words.starts_with("lsystem:");
    });
}

std::optional<Translation> translate_cpfg(const ForeignFile& file, const ForeignModel& model) {
    const std::optional<CpfgSource> source = read_cpfg_source(file);
    if (!source) return std::nullopt;
    const CpfgCompanions companions = find_cpfg_companions(file);
    const CpfgView view = read_cpfg_view(file, companions.view);
    CpfgNames names(file, *source, view);
    std::optional<LSystem> system = read_cpfg_system(names);
    if (!system) return std::nullopt;
    return write_cpfg_system(names, std::move(*system), model, companions.environment);
}

constexpr std::string_view cpfg_endings[] = {"l"};

} // namespace

Importer cpfg_importer() {
    return {"cpfg L-system", cpfg_endings, is_cpfg, "a line 'Lsystem: 1'", one_model, translate_cpfg};
}

} // namespace graftal
