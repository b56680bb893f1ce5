#pragma once

#include <memory>

#include "attempt/servers/server_connection.h"

namespace trocar::attempt {

/// A connection through link/client/haptic_client.h. Errors: see HapticClient::connect.
Result<std::unique_ptr<ServerConnection>> connect_by_link(const link::ClientOptions& options);

}  // namespace trocar::attempt
