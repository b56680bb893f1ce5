#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "web/message.h"

namespace trocar::web {

/// The host of a Host header without its port and brackets, lower case: "localhost", "::1". Empty: malformed.
std::optional<std::string> host_of(std::string_view header);

/// Whether the Host header names this server, which a page that rebinds its own name to this address cannot do (DNS
/// rebinding). Always: "localhost" and loopback numbers if `is_loopback`; else those that `is_served` accepts.
bool is_for_this_host(const HttpRequest& request, bool is_loopback,
                      const std::function<bool(const std::string&)>& is_served);

/// Whether a browser says that another site caused the request. A program that is no browser says nothing: false.
bool is_from_another_site(const HttpRequest& request, std::string_view scheme);

}  // namespace trocar::web
