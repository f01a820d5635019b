#pragma once

#include <string>
#include <string_view>

namespace graftal {

/// Whether a Host header names a machine that no stranger's name leads to: an IP address, or localhost, with
/// any port. A page of another site that has its name changed to our address (DNS rebinding) has another.
bool is_own_host(std::string_view host);

/// Whether an Origin header is that of a page from this host, which the Host header names.
bool is_own_origin(std::string_view origin, std::string_view host);

/// Compares all characters, however early they differ.
bool is_same_secret(std::string_view a, std::string_view b);

/// 128 random bits of the system, as text for an address.
std::string random_token();

/// The header Content-Security-Policy of the page: it loads nothing from elsewhere, and speaks to `host`
/// alone.
std::string page_policy(std::string_view host);

} // namespace graftal
