#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "web/message.h"

namespace trocar::web {

/// Whom a limit of a rate is for: an address of IPv4 ("192.0.2.1", also where it is written as one of IPv6), or the
/// first 64 bits of one of IPv6 ("2001:db8:0:7::/64"), because one machine has all addresses of such a network. Another
/// text is returned as it is.
std::string client_of(std::string_view address);

/// The network of which one party may own all clients: 24 bits of IPv4, 48 bits of IPv6.
std::string network_of(std::string_view client);

/// The last address of all X-Forwarded-For headers, as the proxy in front has appended it, without port and brackets.
/// Empty: there is none, or it is no address.
std::optional<std::string> forwarded_address(const HttpRequest& request);

}  // namespace trocar::web
