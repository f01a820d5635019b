#pragma once

#include <string>
#include <string_view>

namespace graftal {

// Paths as texts, as POSIX has them: nothing here asks a file system.

bool is_absolute_path(std::string_view path);

/// The last name of a path: "tree.inst" of "models/tree.inst"; "" after a final slash.
std::string_view file_name_of(std::string_view path);
/// The ending of its last name with the dot, ".inst"; "" where there is none, and of names such as
/// ".profile".
std::string_view extension_of(std::string_view path);
/// Its last name without the ending.
std::string_view stem_of(std::string_view path);

/// Without "." and empty names, and without ".." after a name; "." in place of nothing. A final slash goes.
std::string normalised_path(std::string_view path);

/// The path that a file's text means by `path`: beside that file, unless it is absolute. Normalised.
std::string path_beside(std::string_view file, std::string_view path);

} // namespace graftal
