#include "runtime/studio/files/linked_files.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/session/session.h"
#include "compiler/support/path_text.h"
#include "compiler/support/text_encoding.h"
#include "runtime/studio/message_reader.h"

namespace graftal {

namespace {

/// Longer files are no models that somebody wrote.
constexpr std::uint64_t most_file_bytes = 1u << 20u, most_bytes_of_all = 4u << 20u;

bool stays_below(std::string_view path) {
    return !is_absolute_path(path) && path != ".." && !path.starts_with("../");
}

/// The path without its last name; "" or with a slash at its end.
std::string folder_of(std::string_view path) {
    return std::string(path.substr(0, path.size() - file_name_of(path).size()));
}

std::string folder_above(std::string_view folder) {
    return folder_of(folder.substr(0, folder.size() - 1));
}

/// The folder in which the paths of a link begin: where the studio was started, or else the last one above
/// the model and its files, since nobody else has the way to it.
std::string link_folder(const std::string& name, const std::map<std::string, FileStamp>& used) {
    if (stays_below(name)) return {};
    std::string folder = folder_of(name);
    for (const auto& file : used)
        while (folder.size() > 1 && !normalised_path(file.first).starts_with(folder))
            folder = folder_above(folder);
    return folder;
}

/// The text of a file; nothing where there is none, or it is no text, or long.
std::optional<std::string> text_of(const std::string& path, const Files& files) {
    std::string bytes;
    if (!files.check(path).ok() || files.stamp(path).bytes > most_file_bytes) return std::nullopt;
    if (!files.read(path, bytes).ok() || bytes.find('\0') != std::string::npos) return std::nullopt;
    return decoded_text(std::move(bytes), OtherBytes::windows_1252);
}

bool may_use(const std::string& path, const StudioHome& home) {
    return home.root().empty() || home.files().lies_in(path, home.root());
}

/// The folder of this home in which the paths of a link begin. The model that the home was opened with keeps
/// its place.
std::string folder_for(const std::string& name, const StudioHome& home) {
    const std::string opened = normalised_path(home.opened().name);
    if (opened.ends_with("/" + name)) return opened.substr(0, opened.size() - name.size());
    const std::string root = normalised_path(home.root());
    if (root == ".") return {};
    return root.ends_with('/') ? root : root + '/';
}

std::string lack_text(const std::vector<std::string>& lacks, const StudioHome& home) {
    constexpr std::size_t most_named = 5;
    std::string names;
    for (std::size_t i = 0; i < std::min(lacks.size(), most_named); ++i)
        names += fmt::format("{}'{}'", i == 0 ? "" : ", ", lacks[i]);
    if (lacks.size() > most_named) names += fmt::format(" and {} more", lacks.size() - most_named);
    const char* const remedy = home.name() == "browser"
                                   ? "Open it in 'graftal studio', with them beside the model."
                                   : "Put them there, and open the link again.";
    return fmt::format("The link does not hold all files that its model uses. It lacks {}. {}", names,
                       remedy);
}

} // namespace

bool LaidFiles::lay(const std::map<std::string, std::string>& files) {
    if (files == laid_) return false;
    for (const auto& file : laid_)
        texts_.remove(file.first);
    laid_ = files;
    for (const auto& [path, text] : laid_)
        texts_.set(path, text);
    return true;
}

void confine_files(StudioState& state, const StudioHome& home) {
    std::erase_if(state.files, [&](const auto& file) { return !may_use(file.first, home); });
}

nlohmann::json link_parts(const StudioState& state, const std::map<std::string, FileStamp>& used,
                          const Files& files) {
    const std::string name = normalised_path(state.name), folder = link_folder(name, used);
    nlohmann::json texts = nlohmann::json::object(), lacks = nlohmann::json::array();
    std::uint64_t bytes = 0;
    for (const auto& [path, stamp] : used) {
        const std::string whole = normalised_path(path);
        const bool is_below = whole.starts_with(folder) && stays_below(whole.substr(folder.size()));
        std::string short_name = is_below ? whole.substr(folder.size()) : std::string(file_name_of(whole));
        std::optional<std::string> text = is_below ? text_of(path, files) : std::nullopt;
        if (text && bytes + text->size() <= most_bytes_of_all) {
            bytes += text->size();
            texts[std::move(short_name)] = *std::move(text);
        } else {
            lacks.push_back(std::move(short_name));
        }
    }
    return {{"name", name.substr(folder.size())}, {"files", std::move(texts)}, {"lacks", std::move(lacks)}};
}

nlohmann::json opened_link(const nlohmann::json& link, StudioHome& home, const CancelFlag& cancel) {
    StudioState state = read_state(link, false);
    if (!state.text || state.name.empty()) throw BadMessage("'name' or 'text' is missing");
    std::string name = normalised_path(state.name);
    if (!stays_below(name)) name = file_name_of(name); // a stranger may have written the link
    const std::string folder = folder_for(name, home);
    for (auto& [path, text] : std::exchange(state.files, {}))
        if (stays_below(path)) state.files[folder + path] = std::move(text);
    confine_files(state, home);
    nlohmann::json files = nlohmann::json::object();
    for (const auto& [path, text] : state.files)
        if (text_of(path, home.files()) != text) files[path] = text;
    LaidFiles laid(home.files());
    laid.lay(state.files);
    std::vector<std::string> lacks;
    const HeardFiles heard(laid.files(), [&](const std::string& path) {
        if (!laid.files().check(path).ok() && std::ranges::find(lacks, path) == lacks.end())
            lacks.push_back(path);
    });
    Session session(folder + name, heard);
    session.edit(*state.text);
    home.equip(session);
    session.set_control({cancel, {}});
    state.stages.lower.root = home.root();
    Compilation unheard; // what is at fault with the text is told when it is shown
    session.lowered(state.stages, unheard);
    if (cancel.raised()) throw BadMessage("interrupted");
    if (!lacks.empty()) throw BadMessage(lack_text(lacks, home));
    return {{"name", folder + name}, {"files", std::move(files)}};
}

} // namespace graftal
