#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/data_set.h"

namespace trocar::dicom::detail {

/// Writes a new DICOM file with the anonymised object: only the elements of kept_elements(), at every level. Encoding
/// and pixels are those of the original. Errors: damaged or truncated sequence, disk full.
Status write_anonymised(const DataSet& original, const ObjectSummary& summary, Anonymisation& rules,
                        const std::filesystem::path& path);

/// Writes a new DICOM file with the unchanged object. Errors: disk full.
Status write_unchanged(const DataSet& original, const ObjectSummary& summary, const std::filesystem::path& path);

/// True for SOP classes of objects (PS3.6, table A-1: below 1.2.840.10008.5.1.4.1.1).
bool is_storage_class(std::string_view sop_class) noexcept;

/// True for the kinds of objects whose content the list of kept elements covers: images, segmentations and structure
/// sets. Others, such as reports, would lose what they are made for.
bool can_anonymise(std::string_view sop_class) noexcept;

/// The preferred of the offered transfer syntaxes: uncompressed before compressed. Empty: Trocar reads none of them.
std::string preferred_transfer_syntax(std::span<const std::string> offered);

/// A presentation context to offer.
struct ContextOffer {
  std::string_view sop_class;
  std::vector<const char*> transfer_syntaxes;
};
/// Contexts for receiving objects on our own connection (C-GET): for each kind that can be anonymised one with the
/// uncompressed encodings, and for images one with each compressed encoding. Fewer than the 128 of an association.
std::vector<ContextOffer> storage_offers();

}  // namespace trocar::dicom::detail
