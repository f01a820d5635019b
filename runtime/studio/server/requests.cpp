#include "runtime/studio/server/requests.h"

#include <algorithm>
#include <random>

#include <boost/asio/ip/address.hpp>
#include <fmt/format.h>

namespace graftal {

namespace {

/// The host without its port; "" where it is malformed.
std::string_view without_port(std::string_view host) {
    const bool bracketed = host.starts_with('[');
    const std::size_t end = bracketed ? host.find(']') : host.find(':');
    std::string_view name = host.substr(0, end);
    std::string_view rest = end == std::string_view::npos ? std::string_view() : host.substr(end);
    if (bracketed) {
        if (rest.empty()) return {};
        name.remove_prefix(1);
        rest.remove_prefix(1);
    }
    if (rest.empty()) return name;
    const std::string_view port = rest.substr(1);
    const bool is_port = rest.front() == ':' && !port.empty() && port.size() <= 5 &&
                         std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; });
    return is_port ? name : std::string_view();
}

} // namespace

bool is_own_host(std::string_view host) {
    const std::string name(without_port(host));
    if (name == "localhost") return true;
    boost::system::error_code no_address;
    boost::asio::ip::make_address(name, no_address);
    return !name.empty() && !no_address;
}

bool is_own_origin(std::string_view origin, std::string_view host) {
    constexpr std::string_view scheme = "http://";
    return origin.starts_with(scheme) && origin.substr(scheme.size()) == host;
}

bool is_same_secret(std::string_view a, std::string_view b) {
    unsigned differences = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        differences |= static_cast<unsigned>(a[i] ^ b[i]);
    return differences == 0;
}

std::string random_token() {
    std::random_device system;
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", system() & 0xffffffffu);
    return token;
}

std::string page_policy(std::string_view host) {
    // The editor makes style sheets of its own.
    return fmt::format(
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; font-src 'self'; worker-src 'self' blob:; "
        "connect-src 'self' ws://{}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        host);
}

} // namespace graftal
