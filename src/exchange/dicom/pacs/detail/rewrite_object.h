#pragma once

#include <filesystem>

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

}  // namespace trocar::dicom::detail
