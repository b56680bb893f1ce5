#include "dicom/pacs/detail/storage_classes.h"

#include <algorithm>
#include <array>

#include "dicom/elements/element_walk.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::string_view kStorage = "1.2.840.10008.5.1.4.1.1.";
constexpr const char* kExplicitLittle = "1.2.840.10008.1.2.1";

// PS3.6, annex A.
constexpr auto kClasses = std::to_array<std::string_view>({
    "1.2.840.10008.5.1.4.1.1.1",      // computed radiography
    "1.2.840.10008.5.1.4.1.1.1.1",    // digital radiography
    "1.2.840.10008.5.1.4.1.1.2",      // CT
    "1.2.840.10008.5.1.4.1.1.2.1",    // enhanced CT
    "1.2.840.10008.5.1.4.1.1.2.2",    // legacy converted enhanced CT
    "1.2.840.10008.5.1.4.1.1.3.1",    // ultrasound, several frames
    "1.2.840.10008.5.1.4.1.1.4",      // MR
    "1.2.840.10008.5.1.4.1.1.4.1",    // enhanced MR
    "1.2.840.10008.5.1.4.1.1.6.1",    // ultrasound
    "1.2.840.10008.5.1.4.1.1.7",      // secondary capture
    "1.2.840.10008.5.1.4.1.1.12.1",   // X-ray angiography
    "1.2.840.10008.5.1.4.1.1.12.2",   // fluoroscopy
    "1.2.840.10008.5.1.4.1.1.20",     // nuclear medicine
    "1.2.840.10008.5.1.4.1.1.66.4",   // segmentation
    "1.2.840.10008.5.1.4.1.1.66.7",   // label map
    "1.2.840.10008.5.1.4.1.1.128",    // PET
    "1.2.840.10008.5.1.4.1.1.481.3",  // structure set
});

constexpr auto kOftenCompressed = std::to_array<std::string_view>({
    "1.2.840.10008.5.1.4.1.1.2",
    "1.2.840.10008.5.1.4.1.1.2.1",
    "1.2.840.10008.5.1.4.1.1.3.1",
    "1.2.840.10008.5.1.4.1.1.4",
    "1.2.840.10008.5.1.4.1.1.4.1",
    "1.2.840.10008.5.1.4.1.1.6.1",
    "1.2.840.10008.5.1.4.1.1.7",
    "1.2.840.10008.5.1.4.1.1.12.1",
    "1.2.840.10008.5.1.4.1.1.66.4",
});

constexpr auto kCompressed = std::to_array<const char*>({
    "1.2.840.10008.1.2.4.70",  // JPEG lossless, first-order prediction
    "1.2.840.10008.1.2.4.57",  // JPEG lossless
    "1.2.840.10008.1.2.4.80",  // JPEG-LS lossless
    "1.2.840.10008.1.2.4.90",  // JPEG 2000 lossless
    "1.2.840.10008.1.2.5",     // run length
    "1.2.840.10008.1.2.4.81",  // JPEG-LS
    "1.2.840.10008.1.2.4.91",  // JPEG 2000
    "1.2.840.10008.1.2.4.51",  // JPEG, 12 bits
    "1.2.840.10008.1.2.4.50",  // JPEG, 8 bits
});

}  // namespace

bool is_storage_class(std::string_view sop_class) noexcept {
  return sop_class.starts_with(kStorage);
}

bool can_anonymise(std::string_view sop_class) noexcept {
  return std::ranges::find(kClasses, sop_class) != kClasses.end();
}

std::string preferred_transfer_syntax(std::span<const std::string> offered) {
  std::vector<std::string_view> order = {kExplicitLittle, kImplicitLittle};
  order.insert(order.end(), kCompressed.begin(), kCompressed.end());
  order.emplace_back("1.2.840.10008.1.2.2");  // big-endian, retired
  for (const std::string_view wanted : order)
    if (std::ranges::find(offered, wanted) != offered.end()) return std::string(wanted);
  return {};
}

std::vector<ContextOffer> storage_offers() {
  std::vector<ContextOffer> offers;
  for (const std::string_view sop_class : kClasses) offers.push_back({sop_class, {kExplicitLittle, kImplicitLittle}});
  for (const std::string_view sop_class : kOftenCompressed)
    for (const char* encoding : kCompressed) offers.push_back({sop_class, {encoding}});
  return offers;
}

}  // namespace trocar::dicom::detail
