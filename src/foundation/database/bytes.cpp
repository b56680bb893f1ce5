#include "database/bytes.h"

namespace trocar::database {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

std::string to_hex(std::string_view bytes) {
  std::string hex;
  hex.reserve(2 * bytes.size());
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    hex += kDigits[value >> 4U];
    hex += kDigits[value & 15U];
  }
  return hex;
}

std::string from_hex(std::string_view hex) {
  std::string bytes;
  bytes.reserve(hex.size() / 2);
  for (std::size_t n = 0; n + 1 < hex.size(); n += 2) {
    const std::size_t high = kDigits.find(hex[n]), low = kDigits.find(hex[n + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos)
      throw soci::soci_error("binary data are damaged");
    bytes += static_cast<char>(high * 16 + low);
  }
  return bytes;
}

}  // namespace

std::string bytes_in(const Database& database, const std::string& placeholder) {
  // SQLite keeps a bound text as text, with its NUL bytes, unless it is told otherwise.
  return database.is_sqlite() ? "CAST(" + placeholder + " AS BLOB)" : "decode(" + placeholder + ", 'hex')";
}

std::string bytes_out(const Database& database, const std::string& column) {
  return database.is_sqlite() ? column : "encode(" + column + ", 'hex')";
}

std::string bind_bytes(const Database& database, std::string_view bytes) {
  return database.is_sqlite() ? std::string(bytes) : to_hex(bytes);
}

std::string from_bytes(const Database& database, std::string text) {
  return database.is_sqlite() ? text : from_hex(text);
}

}  // namespace trocar::database
