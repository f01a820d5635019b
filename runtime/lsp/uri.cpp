#include "runtime/lsp/uri.h"

#include <charconv>

#include <fmt/format.h>

#include "compiler/support/path_text.h"

namespace graftal {

namespace {

std::string read_escapes(std::string_view text) {
    std::string read;
    for (std::size_t at = 0; at < text.size(); ++at) {
        unsigned value = 0;
        if (text[at] == '%' && at + 2 < text.size()) {
            const char* const digits = text.data() + at + 1;
            const auto [end, error] = std::from_chars(digits, digits + 2, value, 16);
            if (error != std::errc() || end != digits + 2) value = 0;
        }
        read += value == 0 ? text[at] : static_cast<char>(value);
        at += value == 0 ? 0 : 2;
    }
    return read;
}

} // namespace

std::string path_of_uri(std::string_view uri) {
    constexpr std::string_view scheme = "file://";
    if (!uri.starts_with(scheme)) return read_escapes(file_name_of(uri));
    uri.remove_prefix(scheme.size());
    const std::size_t slash = uri.find('/'); // after the name of a machine, which is this one
    return slash == std::string_view::npos ? std::string() : normalised_path(read_escapes(uri.substr(slash)));
}

std::string uri_of_path(std::string_view path) {
    std::string uri = "file://";
    if (!is_absolute_path(path)) uri += '/';
    for (const char c : path) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("/-_.~").find(c) != std::string_view::npos;
        if (plain)
            uri += c;
        else
            uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return uri;
}

} // namespace graftal
