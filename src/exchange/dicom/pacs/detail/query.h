#pragma once

#include <string>
#include <string_view>

#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom::detail {

// Identifiers of queries (PS3.4, C.6.2): keys to match, and empty ones that the PACS fills in.
std::string study_query(const std::string& patient_id, Encoding encoding);
std::string series_query(const std::string& study_uid, Encoding encoding);
std::string retrieve_query(const std::string& study_uid, const std::string& series_uid, Encoding encoding);

// Answers. Fields that are missing or damaged are empty.
StudyEntry study_of(const DataSet& answer);
SeriesEntry series_of(const DataSet& answer);

/// A text of a PACS that can be shown: UTF-8 in one line. Bytes above 127 that are no UTF-8 are read as ISO 8859-1.
std::string shown_text(std::string_view text);

}  // namespace trocar::dicom::detail
