#include "compiler/import/cpfg/companions.h"

#include <sstream>
#include <string_view>
#include <vector>

#include "compiler/import/foreign_text.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

bool ends_in(std::string_view word, std::string_view ending) {
    return word.size() > ending.size() && word.ends_with(ending);
}

} // namespace

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

} // namespace graftal
