#include "link/detail/frame.h"

#include <fmt/format.h>

#include <cstring>

#include "link/detail/inspection.h"
#include "link/messages.h"

namespace trocar::link::detail {
namespace {

constexpr flatbuffers::uoffset_t kMostDepth = 4;  ///< Root, Command, SetParameters, TissueSetting.
constexpr flatbuffers::uoffset_t kMostTables = kMostSettings + 8;

}  // namespace

AlignedBytes::AlignedBytes(std::span<const std::byte> bytes)
    : words_((bytes.size() + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t)), size_(bytes.size()) {
  if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
}

flatbuffers::Verifier make_verifier(const AlignedBytes& bytes) {
  return flatbuffers::Verifier(bytes.data(), bytes.size(), kMostDepth, kMostTables);
}

Status check_size(std::size_t bytes) {
  if (bytes == 0) return fail("an empty message", "link", "check the program on the other side");
  if (bytes > kMostMessageBytes) {
    return fail(fmt::format("a message of {} bytes, {} are allowed", bytes, kMostMessageBytes), "link",
                "send smaller messages");
  }
  return {};
}

Status check_frame(const AlignedBytes& bytes, const char* identifier) {
  flatbuffers::Verifier verifier = make_verifier(bytes);
  if (!verifier.VerifyBuffer<wire::Prelude>(identifier)) {
    const bool is_client = std::strcmp(identifier, kClientIdentifier) == 0;
    return fail(fmt::format("not a message of a {}, or a damaged one", is_client ? "client" : "server"), "link",
                "check that the other side is a Trocar program");
  }
  const std::uint32_t version = flatbuffers::GetRoot<wire::Prelude>(bytes.data())->version();
  if (version != kLinkVersion) {
    return fail(
        fmt::format("the other side speaks version {} of the link, this program version {}", version, kLinkVersion),
        "link", "install the same version of Trocar on both sides");
  }
  return {};
}

Bytes take_bytes(const flatbuffers::FlatBufferBuilder& builder) {
  const auto* begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  return {begin, begin + builder.GetSize()};
}

}  // namespace trocar::link::detail
