#include "compiler/support/files.h"

#include <utility>

#include <fmt/format.h>

#include "compiler/support/path_text.h"

namespace graftal {

void MemoryFiles::set(const std::string& path, std::string text) {
    entries_[normalised_path(path)] = {std::move(text), ++edits_};
}

void MemoryFiles::remove(const std::string& path) {
    entries_.erase(normalised_path(path));
}

const MemoryFiles::Entry* MemoryFiles::find(const std::string& path) const {
    const auto found = entries_.find(normalised_path(path));
    return found == entries_.end() ? nullptr : &found->second;
}

Status MemoryFiles::check(const std::string& path) const {
    if (find(path)) return {};
    if (below_) return below_->check(path);
    return Status::failure(fmt::format("cannot open '{}': there is no such file", path));
}

Status MemoryFiles::read(const std::string& path, std::string& text) const {
    if (const Entry* const entry = find(path)) {
        text = entry->text;
        return {};
    }
    return below_ ? below_->read(path, text) : check(path);
}

FileStamp MemoryFiles::stamp(const std::string& path) const {
    if (const Entry* const entry = find(path)) return {entry->edit, entry->text.size()};
    return below_ ? below_->stamp(path) : FileStamp();
}

bool MemoryFiles::lies_in(const std::string& path, const std::string& folder) const {
    // The files below know that an absolute path leads into the folder where the program was started.
    const bool is_there = below_ && below_->lies_in(path, folder);
    if (is_there || (below_ && !find(path))) return is_there;
    const std::string inner = normalised_path(path), outer = normalised_path(folder);
    if (outer == ".") return !is_absolute_path(inner) && inner != ".." && !inner.starts_with("../");
    return inner == outer || inner.starts_with(outer.ends_with('/') ? outer : outer + '/');
}

} // namespace graftal
