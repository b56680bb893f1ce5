#include "link/endpoint.h"

#include <fmt/format.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core/log.h"
#include "core/parse_number.h"
#include "link/detail/plain_text.h"
#include "link/detail/private_folder.h"
#include "link/zmtp/detail/tcp_address.h"

namespace trocar::link {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kMostPathBytes = sizeof(sockaddr_un::sun_path) - 1;
constexpr std::string_view kAdvice = "write ipc:///PATH, or tcp://ADDRESS:PORT as in tcp://127.0.0.1:5571";

Result<Endpoint> parse_ipc(std::string_view path) {
  const std::string where = fmt::format("{}{}", kIpcScheme, path);
  if (!path.starts_with('/')) return fail_usage("the socket's path is not absolute", where, std::string(kAdvice));
  if (path.ends_with('/')) return fail_usage("names a folder, not a socket", where, std::string(kAdvice));
  if (path.size() > kMostPathBytes) {
    return fail_usage(fmt::format("the socket's path has {} bytes, {} are possible", path.size(), kMostPathBytes),
                      where, "choose a shorter one");
  }
  return Endpoint{where, false};
}

Result<Endpoint> parse_tcp(std::string_view address) {
  constexpr unsigned kMostPort = 65535;
  const std::string where = fmt::format("{}{}", kTcpScheme, address);
  const std::size_t colon = address.rfind(':');
  if (colon == std::string_view::npos) return fail_usage("the port is missing", where, std::string(kAdvice));
  std::string_view host = address.substr(0, colon);
  const auto port = parse_number<unsigned>(address.substr(colon + 1));
  if (!port || *port > kMostPort)
    return fail_usage(fmt::format("the port is not a number of 0 to {}", kMostPort), where,
                      "write it as tcp://127.0.0.1:5571");
  if (host == "localhost") host = "127.0.0.1";  // sockets cannot be bound to names
  const auto parsed = detail::parse_tcp_address(host, *port);
  if (!parsed) {
    return fail_usage("not an IP address (names are not looked up)", where,
                      "write the address in numbers, as in tcp://192.168.1.7:5571 or tcp://[::1]:5571");
  }
  return Endpoint{parsed->url(), true};
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text) {
  if (text.empty()) return fail_usage("no endpoint is given", "endpoint", std::string(kAdvice));
  if (!detail::is_plain_text(text, detail::Layout::kLine)) {
    return fail_usage("has control characters or is not UTF-8", "endpoint", std::string(kAdvice));
  }
  if (text.starts_with(kIpcScheme)) return parse_ipc(text.substr(kIpcScheme.size()));
  if (text.starts_with(kTcpScheme)) return parse_tcp(text.substr(kTcpScheme.size()));
  return fail_usage("neither ipc:// nor tcp://", std::string(text), std::string(kAdvice));
}

std::string default_endpoint(std::string_view tool) {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  fs::path folder = runtime == nullptr ? "" : runtime;
  if (!folder.is_absolute() || !detail::check_private_folder(folder)) {
    folder = fmt::format("/tmp/trocar-{}", ::geteuid());
    if (const Status made = detail::make_private_folder(folder); !made) {
      log_warning("no folder for the endpoint: {}", made.error().text());
      return {};
    }
  }
  return fmt::format("{}{}", kIpcScheme, (folder / fmt::format("trocar-{}", tool)).string());
}

}  // namespace trocar::link
