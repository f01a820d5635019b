#pragma once

#include <string>
#include <string_view>

namespace graftal {

/// The path of a `file:` URI, with its escapes read; the last name of any other, so that it lies beside no
/// file.
std::string path_of_uri(std::string_view uri);

/// The `file:` URI of a path; what URIs cannot hold is escaped.
std::string uri_of_path(std::string_view path);

} // namespace graftal
