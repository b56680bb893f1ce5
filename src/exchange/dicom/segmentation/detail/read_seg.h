#pragma once

#include "dicom/elements/dicom_file.h"
#include "dicom/segmentation/segmentation.h"

namespace trocar::dicom::detail {

/// read_segmentation() of a DICOM SEG that belongs to the CT.
Result<Segmentation> read_seg(const DicomFile& file, const std::string& where, const CtReference& ct,
                              const std::function<bool(const Segment&)>& is_wanted, const FrameDecoder& decode);

}  // namespace trocar::dicom::detail
