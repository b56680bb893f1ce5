#include "signing/sha256.h"

#include <sodium.h>

#include <fstream>
#include <vector>

#include "core/files/input_file.h"
#include "signing/signing_key.h"

namespace trocar::signing {
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
