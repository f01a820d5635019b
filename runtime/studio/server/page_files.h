#pragma once

#include <span>
#include <string_view>

namespace graftal {

/// A file of the page, which the program holds.
struct PageFile {
    std::string_view name; ///< "index.html"
    std::string_view type; ///< for browsers: "text/html; charset=utf-8"
    std::string_view bytes;
};

/// All files of the page that the build has made (cmake/studio.cmake).
std::span<const PageFile> page_files();

} // namespace graftal
