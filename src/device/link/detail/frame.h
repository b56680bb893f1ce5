#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/result.h"
#include "link/codec.h"
#include "link/detail/messages_generated.h"

namespace trocar::link::detail {

inline constexpr char kClientIdentifier[] = "TRCC";  ///< File identifier of a client's message.
inline constexpr char kServerIdentifier[] = "TRCS";

/// An aligned copy of a message. Bytes from a socket may start at any address.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::span<const std::byte> bytes);
  const std::uint8_t* data() const { return reinterpret_cast<const std::uint8_t*>(words_.data()); }
  std::size_t size() const { return size_; }

 private:
  std::vector<std::uint64_t> words_;  ///< Type with the strictest alignment in a message.
  std::size_t size_;
};

/// Check size, identifier and version before a byte is copied or another field is read.
Status check_size(std::size_t bytes);
Status check_frame(const AlignedBytes& bytes, const char* identifier);
flatbuffers::Verifier make_verifier(const AlignedBytes& bytes);

/// Returns the verified root; valid during the lifetime of `bytes`.
template <class Root>
Result<const Root*> find_root(const AlignedBytes& bytes, const char* identifier) {
  TROCAR_TRY_STATUS(check_frame(bytes, identifier));
  flatbuffers::Verifier verifier = make_verifier(bytes);
  if (!verifier.VerifyBuffer<Root>(identifier))
    return fail("a message that is cut or damaged", "link", "check the program on the other side");
  return flatbuffers::GetRoot<Root>(bytes.data());
}

/// A body as a member of the union in the root.
template <class Type>
using Member = std::pair<Type, flatbuffers::Offset<void>>;

/// Copies the built message out of the builder.
Bytes take_bytes(const flatbuffers::FlatBufferBuilder& builder);

/// FlatBuffers has 32-bit offsets; the built messages are far smaller.
using Builder = flatbuffers::FlatBufferBuilder;
using Text = flatbuffers::Offset<flatbuffers::String>;

}  // namespace trocar::link::detail
