#include "link/endpoint.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <zmq.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>

#include "core/files/output_file.h"
#include "core/log.h"
#include "core/text.h"
#include "link/detail/inspection.h"
#include "link/detail/ipc_file.h"
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

namespace {
namespace fs = std::filesystem;

constexpr std::size_t kKeyCharacters = 40;  ///< 32 bytes in Z85.
constexpr std::size_t kKeyBytes = 32;
constexpr std::size_t kMostKeyFileBytes = 4096;
constexpr std::size_t kMostAllowListBytes = 1 << 20;
constexpr mode_t kOthersMayWrite = 0022;
constexpr std::string_view kPublicWord = "public";
constexpr std::string_view kSecretWord = "secret";

using KeyBuffer = std::array<char, kKeyCharacters + 1>;  ///< As required by libzmq: with a NUL at the end.

bool is_key(const std::string& text) {
  std::array<std::uint8_t, kKeyBytes> bytes;
  return text.size() == kKeyCharacters && ::zmq_z85_decode(bytes.data(), text.c_str()) != nullptr;
}

/// The first two words of a line, without its comment.
struct Words {
  std::string first, second;
  bool has_more = false;
};

/// A word that begins with # starts a comment. No key does: # is in Z85's alphabet, but five characters from it on
/// exceed 32 bits.
Words split(const std::string& line) {
  std::istringstream stream(line);
  Words words;
  for (std::string word; stream >> word;) {
    if (word.starts_with('#')) break;
    if (words.first.empty()) {
      words.first = word;
    } else if (words.second.empty()) {
      words.second = word;
    } else {
      words.has_more = true;
    }
  }
  return words;
}

/// Calls `take` with the words and the number of every non-empty line, until it reports an error.
template <class Take>
Status read_lines(const fs::path& file, std::size_t most_bytes, Take&& take) {
  TROCAR_TRY(const std::string text, read_file(file, most_bytes));
  std::istringstream stream(text);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const Words words = split(line);
    if (words.first.empty()) continue;
    if (words.has_more || !take(words)) {
      return fail("not a key of 40 characters in Z85", fmt::format("{}, line {}", file.string(), number),
                  "write keys with: trocar link keygen --out DIR");
    }
  }
  return {};
}

Result<std::set<std::string>> read_public_keys(const fs::path& file, std::size_t most_bytes) {
  std::set<std::string> keys;
  TROCAR_TRY_STATUS(read_lines(file, most_bytes, [&](const Words& words) {
    if (!is_key(words.first) || !words.second.empty()) return false;
    keys.insert(words.first);
    return true;
  }));
  return keys;
}

/// Users who can write to such a file decide which keys this program trusts.
Status check_written_by_user_alone(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return fail("no such file", file.string(), "check the path");
  if ((status.st_mode & kOthersMayWrite) != 0) {
    return fail("the key file is writable by other users", file.string(), fmt::format("chmod go-w {}", file.string()));
  }
  if (status.st_uid == ::geteuid() || status.st_uid == 0) return check_folders_of(file);
  return fail("the key file belongs to another user", file.string(), "copy it: cp FILE COPY");
}

/// NAME.key and NAME.pub in a folder.
Result<CurveKeys> write_pair(const fs::path& folder, std::string_view name) {
  TROCAR_TRY(CurveKeys keys, make_curve_keys());
  TROCAR_TRY_STATUS(write_private_file(folder / fmt::format("{}.key", name),
                                       fmt::format("# Key pair of a Trocar {}: keep it secret.\n{} {}\n{} {}\n", name,
                                                   kPublicWord, keys.public_key, kSecretWord, keys.secret_key)));
  TROCAR_TRY_STATUS(write_file_atomically(folder / fmt::format("{}.pub", name),
                                          fmt::format("# Public key of a Trocar {}.\n{}\n", name, keys.public_key)));
  return keys;
}

}  // namespace

Result<CurveKeys> make_curve_keys() {
  KeyBuffer public_key{}, secret_key{};
  if (::zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) {
    return fail(std::string("cannot create keys: ") + ::zmq_strerror(errno), "libzmq", "install a libzmq with CURVE");
  }
  return CurveKeys{public_key.data(), secret_key.data()};
}

Status write_key_folder(const fs::path& folder) {
  return write_folder_atomically(folder, [](const fs::path& temporary) -> Status {
    std::error_code error;
    fs::permissions(temporary, fs::perms::owner_all, error);
    if (error)
      return fail("cannot be closed to others: " + error.message(), temporary.string(),
                  "choose a folder on a file system with permissions");
    TROCAR_TRY_STATUS(write_pair(temporary, "server"));
    TROCAR_TRY(const CurveKeys client, write_pair(temporary, "client"));
    return write_file_atomically(
        temporary / "allowed",
        fmt::format("# Public keys of the clients that may connect, one a line.\n{}  # client\n", client.public_key));
  });
}

Result<CurveKeys> load_curve_keys(const fs::path& file) {
  TROCAR_TRY_STATUS(check_private_file(file));
  CurveKeys keys;
  TROCAR_TRY_STATUS(read_lines(file, kMostKeyFileBytes, [&](const Words& words) {
    const bool is_public = words.first == kPublicWord;
    std::string& key = is_public ? keys.public_key : keys.secret_key;
    if ((!is_public && words.first != kSecretWord) || !key.empty() || !is_key(words.second)) return false;
    key = words.second;
    return true;
  }));
  if (keys.public_key.empty() || keys.secret_key.empty()) {
    return fail("does not contain both keys", file.string(), "name a .key file of: trocar link keygen --out DIR");
  }
  KeyBuffer derived{};
  if (::zmq_curve_public(derived.data(), keys.secret_key.c_str()) != 0 || keys.public_key != derived.data()) {
    return fail("public and secret key do not match", file.string(), "make new keys");
  }
  return keys;
}

Result<std::string> load_public_key(const fs::path& file) {
  TROCAR_TRY_STATUS(check_written_by_user_alone(file));
  TROCAR_TRY(const auto keys, read_public_keys(file, kMostKeyFileBytes));
  if (keys.size() == 1) return *keys.begin();
  return fail(fmt::format("contains {} public keys instead of one", keys.size()), file.string(), "name a .pub file");
}

Result<std::set<std::string>> load_allow_list(const fs::path& file) {
  TROCAR_TRY_STATUS(check_written_by_user_alone(file));
  TROCAR_TRY(std::set<std::string> keys, read_public_keys(file, kMostAllowListBytes));
  if (keys.empty())
    return fail("the list allows no client: it has no key", file.string(),
                "add the key of a client's .pub file, one a line");
  return keys;
}

}  // namespace trocar::link
