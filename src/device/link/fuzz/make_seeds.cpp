// Writes valid messages of every kind into a folder, as seeds of a fuzzer.
#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "core/files/output_file.h"
#include "link/codec.h"
#include "link/test/random_message.h"

namespace trocar::link {
namespace {

constexpr std::uint64_t kSeeds = 4;  ///< Per kind of message.

template <class Message>
Status write_all(const std::filesystem::path& folder, std::string_view side, std::uint64_t seed,
                 const std::vector<Message>& messages) {
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const Bytes bytes = encode(messages[i]);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    TROCAR_TRY_STATUS(write_file_atomically(folder / fmt::format("{}-{}-{}", side, i, seed), text));
  }
  return {};
}

Status write_seeds(const std::filesystem::path& folder) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    RandomMessages random(seed);
    TROCAR_TRY_STATUS(write_all(folder, "client", seed, random.client_messages()));
    TROCAR_TRY_STATUS(write_all(folder, "server", seed, random.server_messages()));
  }
  return {};
}

}  // namespace
}  // namespace trocar::link

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: make_seeds FOLDER\n");
    return 2;
  }
  const trocar::Status written = trocar::link::write_seeds(argv[1]);
  if (!written) fmt::print(stderr, "error: {}\n", written.error().text());
  return written ? 0 : 1;
}
