#pragma once

#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/segmentation.h"

namespace trocar::dicom::detail {

/// read_segmentation() of an RT structure set that belongs to the CT.
Result<Segmentation> read_structure_set(const DicomFile& file, const std::string& where, const CtReference& ct,
                                        const std::function<bool(const Segment&)>& is_wanted);

}  // namespace trocar::dicom::detail
