#pragma once

#include <chrono>
#include <string_view>

#include "results/repository.h"

namespace trocar::results {

/// A client is forgotten so long after the last login from it, and beyond so many newer ones of an account.
inline constexpr std::chrono::days kLoginClientKept{90};
inline constexpr int kMostLoginClients = 50;

/// Notes that somebody has logged in to an account from a client: its address, or its network.
Status note_login_client(Repository& repository, std::string_view account_id, std::string_view client, Seconds now);
/// Whether it was noted for the account of this name.
Result<bool> is_login_client(Repository& repository, std::string_view account_name, std::string_view client,
                             Seconds now);

}  // namespace trocar::results
