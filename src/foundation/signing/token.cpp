#include "signing/token.h"

#include <sodium.h>

#include <array>
#include <fstream>
#include <vector>

#include "core/files/input_file.h"
#include "core/result.h"
#include "signing/signing_key.h"

namespace trocar::signing {
namespace {

constexpr int kFewestBits = 128;
constexpr int kMostBits = 512;
constexpr int kBase64 = sodium_base64_VARIANT_URLSAFE_NO_PADDING;

}  // namespace

Result<std::string> make_token(int bits) {
  TROCAR_CHECK(bits >= kFewestBits && bits <= kMostBits && bits % 8 == 0);
  if (sodium_init() < 0) return fail("cryptography cannot be used", "libsodium", "reinstall libsodium");
  std::vector<unsigned char> bytes(static_cast<std::size_t>(bits / 8));
  randombytes_buf(bytes.data(), bytes.size());
  std::string token(sodium_base64_encoded_len(bytes.size(), kBase64), '\0');
  sodium_bin2base64(token.data(), token.size(), bytes.data(), bytes.size(), kBase64);
  token.pop_back();  // the terminating zero
  return token;
}

std::string make_id() {
  TROCAR_CHECK(sodium_init() >= 0);
  std::array<std::uint8_t, 16> bytes;
  randombytes_buf(bytes.data(), bytes.size());
  return to_hex(bytes);
}

std::string token_digest(std::string_view token) {
  return sha256(token);
}

bool is_same_secret(std::string_view a, std::string_view b) noexcept {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

namespace {

using Digest = std::array<std::uint8_t, crypto_hash_sha256_BYTES>;
constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return to_hex(digest);
}

Result<std::string> sha256_of_session(const std::filesystem::path& file) {
  TROCAR_TRY(const InputFile input, InputFile::open(file, FileKind::kSession));
  std::ifstream stream(input.pinned_path(), std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(piece.data()),
                              static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) return fail("cannot be read", file.string(), "check the disk");
  Digest digest;
  crypto_hash_sha256_final(&state, digest.data());
  return to_hex(digest);
}

}  // namespace trocar::signing
