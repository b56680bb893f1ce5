#include "io/ct_series/detail/dicom_header.h"

#include <algorithm>
#include <string_view>

namespace trocar::io::detail {
namespace {

constexpr std::size_t kMaxKept = 4096;  ///< Longer elements are not header text.

bool is_kept(const dicom::Element& element) {
  return !element.has_undefined_length && element.size <= kMaxKept &&
         std::ranges::find(dicom_tags::kAll, element.tag) != dicom_tags::kAll.end();
}

}  // namespace

DicomHeader::DicomHeader(dicom::DicomFile file) : file_(std::move(file)) {
  dicom::ElementWalk walk = file_.elements();
  dicom::Element element;
  while (walk.next(element) == dicom::ElementWalk::Step::kElement)
    if (is_kept(element)) elements_[element.tag] = element;
}

Result<std::optional<DicomHeader>> DicomHeader::read(const std::filesystem::path& path) {
  TROCAR_TRY(std::optional<dicom::DicomFile> file, dicom::DicomFile::read(path));
  if (!file) return std::optional<DicomHeader>();
  return std::optional(DicomHeader(*std::move(file)));
}

std::string_view DicomHeader::bytes_of(std::uint32_t tag) const {
  const auto found = elements_.find(tag);
  if (found == elements_.end()) return {};
  return file_.bytes().substr(found->second.begin, found->second.size);
}

std::string DicomHeader::text(std::uint32_t tag) const {
  return std::string(dicom::without_padding(bytes_of(tag)));
}

std::optional<int> DicomHeader::number(std::uint32_t tag) const {
  return dicom::unsigned_short(bytes_of(tag), file_.is_big_endian());
}

}  // namespace trocar::io::detail
