#include "compiler/support/path_text.h"

#include <vector>

namespace graftal {

bool is_absolute_path(std::string_view path) {
    return path.starts_with('/');
}

std::string_view file_name_of(std::string_view path) {
    return path.substr(path.find_last_of('/') + 1); // npos + 1 is 0
}

std::string_view extension_of(std::string_view path) {
    const std::string_view name = file_name_of(path);
    const std::size_t dot = name.find_last_of('.');
    return dot == std::string_view::npos || dot == 0 || name == ".." ? std::string_view() : name.substr(dot);
}

std::string_view stem_of(std::string_view path) {
    std::string_view name = file_name_of(path);
    name.remove_suffix(extension_of(path).size());
    return name;
}

std::string normalised_path(std::string_view path) {
    const bool absolute = is_absolute_path(path);
    std::vector<std::string_view> names;
    while (!path.empty()) {
        const std::size_t slash = path.find('/');
        const std::string_view name = path.substr(0, slash);
        path.remove_prefix(slash == std::string_view::npos ? path.size() : slash + 1);
        if (name.empty() || name == ".") continue;
        const bool goes_up = name == "..";
        if (goes_up && !names.empty() && names.back() != "..")
            names.pop_back();
        else if (!goes_up || !absolute) // above the root there is the root
            names.push_back(name);
    }
    std::string text = absolute ? "/" : "";
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += '/';
        text += names[i];
    }
    return text.empty() ? "." : text;
}

std::string path_beside(std::string_view file, std::string_view path) {
    if (is_absolute_path(path)) return normalised_path(path);
    const std::size_t name = file.size() - file_name_of(file).size();
    return normalised_path(std::string(file.substr(0, name)).append(path));
}

} // namespace graftal
