#pragma once

#include <signal.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace trocar::dicom::detail {

/// Values of CommandField (PS3.7, E.1). A response has the highest bit set.
enum class DimseField : std::uint16_t {
  kStore = 0x0001,
  kGet = 0x0010,
  kFind = 0x0020,
  kMove = 0x0021,
  kEcho = 0x0030,
  kCancel = 0x0fff,
  kStoreResponse = 0x8001,
  kGetResponse = 0x8010,
  kFindResponse = 0x8020,
  kMoveResponse = 0x8021,
  kEchoResponse = 0x8030,
};

/// The command set of a message (PS3.7, E.1). Absent elements are empty.
struct DimseCommand {
  DimseField field = DimseField::kEcho;
  std::string sop_class;
  std::string sop_instance;
  std::string destination;  ///< AE title, of C-MOVE requests.
  std::optional<std::uint16_t> message_id;
  std::optional<std::uint16_t> responded_id;
  std::optional<std::uint16_t> status;
  std::optional<std::uint16_t> completed;  ///< Objects sent so far.
  std::optional<std::uint16_t> remaining;
  std::optional<std::uint16_t> failed;
  std::string comment;  ///< Of a failure, by the PACS.
  bool has_data = false;
};

std::string encode(const DimseCommand& command);
/// Empty if the bytes are no command set.
std::optional<DimseCommand> decode_command(std::string_view bytes);

/// FF00, FF01: more responses follow.
bool is_pending(std::uint16_t status) noexcept;

/// DCMTK prints nothing, waits at most `timeout_s` for bytes, and looks up no names of peers. The settings belong to
/// the whole process.
void configure_dcmtk(int timeout_s);

/// While an object exists, writing to a closed connection is an error of the call and does not end the program. For
/// libraries that write without MSG_NOSIGNAL; affects the calling thread.
class BrokenPipesIgnored {
 public:
  BrokenPipesIgnored() noexcept;
  ~BrokenPipesIgnored();
  BrokenPipesIgnored(const BrokenPipesIgnored&) = delete;
  BrokenPipesIgnored& operator=(const BrokenPipesIgnored&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace trocar::dicom::detail
