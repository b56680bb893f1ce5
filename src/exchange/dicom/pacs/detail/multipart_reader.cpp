#include "dicom/pacs/detail/multipart_reader.h"

#include <algorithm>

#include "core/ascii.h"
#include "dicom/pacs/detail/data_set.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::size_t kMaxPartHeader = std::size_t{1} << 14;
constexpr std::size_t kMaxBoundary = 70;  // RFC 2046
constexpr std::string_view kEndOfHeader = "\r\n\r\n";

tl::unexpected<Error> not_multipart() {
  return fail("the answer of the server is no series of DICOM objects", "WADO-RS",
              "check that this is the address of its DICOMweb service");
}

}  // namespace

std::optional<std::string> multipart_boundary(std::string_view content_type) {
  const std::string small = ascii::lower_case(content_type);
  const std::size_t at = small.find("boundary=");
  if (!small.starts_with("multipart/related") || at == std::string::npos) return std::nullopt;
  std::string_view value = content_type.substr(at + std::string_view("boundary=").size());
  if (value.starts_with('"')) {
    value.remove_prefix(1);
    value = value.substr(0, value.find('"'));
  } else {
    value = value.substr(0, value.find_first_of("; \t"));
  }
  const bool is_printable = std::ranges::all_of(value, [](char c) { return c >= ' ' && c < 0x7f; });
  if (value.empty() || value.size() > kMaxBoundary || !is_printable) return std::nullopt;
  return std::string(value);
}

MultipartReader::MultipartReader(const std::string& boundary, ObjectSink& sink)
    : sink_(sink), delimiter_("\r\n--" + boundary), buffer_("\r\n") {}  // the first delimiter may begin the content

Status MultipartReader::push(std::string_view bytes) {
  if (state_ == State::kDone) return {};  // RFC 2046: what follows is ignored
  buffer_ += bytes;
  while (true) {
    TROCAR_TRY(const bool has_more, step());
    if (!has_more) return {};
  }
}

Status MultipartReader::finish() const {
  if (state_ == State::kDone) return {};
  return fail("the answer of the server ends too early", "WADO-RS", "try again");
}

Status MultipartReader::pass_on(std::size_t size) {
  if (state_ == State::kPart && size > 0) TROCAR_TRY_STATUS(sink_.append(std::string_view(buffer_).substr(0, size)));
  buffer_.erase(0, size);
  return {};
}

/// False: more bytes are needed.
Result<bool> MultipartReader::step() {
  if (state_ == State::kBefore || state_ == State::kPart) {
    const std::size_t found = buffer_.find(delimiter_);
    if (found == std::string::npos) {  // the end of the buffer may be the start of a delimiter
      TROCAR_TRY_STATUS(pass_on(buffer_.size() - std::min(buffer_.size(), delimiter_.size() - 1)));
      return false;
    }
    TROCAR_TRY_STATUS(pass_on(found));
    if (state_ == State::kPart) TROCAR_TRY_STATUS(sink_.end({}));
    buffer_.erase(0, delimiter_.size());
    state_ = State::kAfterBoundary;
    return true;
  }
  if (state_ == State::kAfterBoundary) {
    if (buffer_.size() < 2) return false;
    state_ = buffer_.starts_with("--") ? State::kDone : State::kHeader;
    if (state_ == State::kDone) buffer_.clear();
    return state_ == State::kHeader;
  }
  if (state_ == State::kHeader) {  // from the end of the boundary's line to an empty line
    const std::size_t end = buffer_.find(kEndOfHeader);
    if (std::min(end, buffer_.size()) > kMaxPartHeader) return not_multipart();
    if (end == std::string::npos) return false;
    buffer_.erase(0, end + kEndOfHeader.size());
    state_ = State::kPart;
    TROCAR_TRY_STATUS(sink_.begin());
    return true;
  }
  return false;
}

}  // namespace trocar::dicom::detail
