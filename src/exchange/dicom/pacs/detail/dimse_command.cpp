#include "dicom/pacs/detail/dimse_command.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dcmtrans.h>
#include <dcmtk/dcmnet/dul.h>
#include <dcmtk/oflog/oflog.h>
#include <pthread.h>

#include <ctime>
#include <mutex>

#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom::detail {
namespace {

constexpr Encoding kImplicit{.is_big_endian = false, .is_implicit = true};  // PS3.7, 6.3.1
constexpr std::uint32_t kGroupLength = tag(0x0000, 0x0000);
constexpr std::uint32_t kAffectedSopClass = tag(0x0000, 0x0002);
constexpr std::uint32_t kField = tag(0x0000, 0x0100);
constexpr std::uint32_t kMessageId = tag(0x0000, 0x0110);
constexpr std::uint32_t kRespondedId = tag(0x0000, 0x0120);
constexpr std::uint32_t kDestination = tag(0x0000, 0x0600);
constexpr std::uint32_t kPriority = tag(0x0000, 0x0700);
constexpr std::uint32_t kDataSetType = tag(0x0000, 0x0800);
constexpr std::uint32_t kStatus = tag(0x0000, 0x0900);
constexpr std::uint32_t kComment = tag(0x0000, 0x0902);
constexpr std::uint32_t kSopInstance = tag(0x0000, 0x1000);
constexpr std::uint32_t kRemaining = tag(0x0000, 0x1020);
constexpr std::uint32_t kCompleted = tag(0x0000, 0x1021);
constexpr std::uint32_t kFailed = tag(0x0000, 0x1022);
constexpr std::uint16_t kNoData = 0x0101;
constexpr std::uint16_t kSomeData = 0x0001;

std::string us(std::uint16_t value) {
  return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
}

std::optional<std::uint16_t> parse_us(std::string_view value) {
  if (value.size() != 2) return std::nullopt;
  return static_cast<std::uint16_t>(static_cast<unsigned char>(value[0]) | static_cast<unsigned char>(value[1]) << 8);
}

void take(DimseCommand& command, std::uint32_t tag, std::string_view value) {
  const auto number = parse_us(value);
  if (tag == kAffectedSopClass) command.sop_class = trimmed(value);
  if (tag == kSopInstance) command.sop_instance = trimmed(value);
  if (tag == kField && number) command.field = static_cast<DimseField>(*number);
  if (tag == kMessageId) command.message_id = number;
  if (tag == kRespondedId) command.responded_id = number;
  if (tag == kStatus) command.status = number;
  if (tag == kCompleted) command.completed = number;
  if (tag == kRemaining) command.remaining = number;
  if (tag == kFailed) command.failed = number;
  if (tag == kComment) command.comment = trimmed(value);
  if (tag == kDataSetType) command.has_data = number && *number != kNoData;
}

}  // namespace

std::string encode(const DimseCommand& command) {
  std::string body;
  const auto add = [&](std::uint32_t tag, std::string_view vr, std::string_view value) {
    body += encoded_element(tag, vr, value, kImplicit);
  };
  if (!command.sop_class.empty()) add(kAffectedSopClass, "UI", command.sop_class);
  add(kField, "US", us(static_cast<std::uint16_t>(command.field)));
  if (command.message_id) add(kMessageId, "US", us(*command.message_id));
  if (command.responded_id) add(kRespondedId, "US", us(*command.responded_id));
  if (!command.destination.empty()) add(kDestination, "AE", command.destination);
  if (command.message_id && command.field != DimseField::kEcho) add(kPriority, "US", us(0));  // medium
  add(kDataSetType, "US", us(command.has_data ? kSomeData : kNoData));
  if (command.status) add(kStatus, "US", us(*command.status));
  if (!command.sop_instance.empty()) add(kSopInstance, "UI", command.sop_instance);
  const auto size = static_cast<std::uint16_t>(body.size());  // a few UIDs and numbers
  return encoded_element(kGroupLength, "UL", us(size) + us(0), kImplicit) + body;
}

std::optional<DimseCommand> decode_command(std::string_view bytes) {
  DimseCommand command;
  bool has_field = false;
  ElementWalk walk(bytes, kImplicit);
  Element element;
  auto step = ElementWalk::Step::kEnd;
  while ((step = walk.next(element)) == ElementWalk::Step::kElement) {
    has_field |= element.tag == kField;
    take(command, element.tag, bytes.substr(element.begin, element.size));
  }
  if (step == ElementWalk::Step::kDamaged || !has_field) return std::nullopt;
  return command;
}

bool is_pending(std::uint16_t status) noexcept {
  return status == 0xff00 || status == 0xff01;
}

}  // namespace trocar::dicom::detail

// DCMTK's headers need this one first.

namespace trocar::dicom::detail {

void configure_dcmtk(int timeout_s) {
  static std::once_flag once;
  std::call_once(once, [] { OFLog::configure(OFLogger::OFF_LOG_LEVEL); });
  dcmDisableGethostbyaddr.set(OFTrue);
  dcmConnectionTimeout.set(timeout_s);
  dcmSocketReceiveTimeout.set(timeout_s);
  dcmSocketSendTimeout.set(timeout_s);
}

BrokenPipesIgnored::BrokenPipesIgnored() noexcept {
  sigset_t pipe;
  ::sigemptyset(&pipe);
  ::sigaddset(&pipe, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &pipe, &before_);
}

BrokenPipesIgnored::~BrokenPipesIgnored() {
  if (::sigismember(&before_, SIGPIPE) == 0) {
    sigset_t pipe;
    ::sigemptyset(&pipe);
    ::sigaddset(&pipe, SIGPIPE);
    const timespec now{};
    while (::sigtimedwait(&pipe, nullptr, &now) == SIGPIPE) {
    }
  }
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace trocar::dicom::detail
