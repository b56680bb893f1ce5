#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/character_set.h"
#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom::detail {

/// The elements of a received object, without meta information: a view of its bytes.
struct DataSet {
  std::string_view bytes;
  Encoding encoding;
  std::string transfer_syntax;  ///< UID
};

/// The encoding of a transfer syntax (PS3.5, annex A). Error: deflated, which Trocar does not read.
Result<Encoding> encoding_of(std::string_view transfer_syntax);

/// The data set of a received object. `transfer_syntax` as agreed with the sender; empty: the object is a DICOM file
/// that names it in its meta information. Errors: not a DICOM file, deflated.
Result<DataSet> find_data_set(std::string_view object, const std::string& transfer_syntax);

/// The elements that decide how an object is treated.
struct ObjectSummary {
  std::string sop_class;     ///< UID
  std::string sop_instance;  ///< UID
  std::string study;         ///< UID
  std::string series;        ///< UID
  std::string patient_id;
  std::string modality;
  std::optional<int> instance_number;
  bool may_show_text = false;  ///< Names may be written into the pixels: stated, or usual for this kind of image.
  Repertoire repertoire = Repertoire::kAscii;
  IdentityWords names;
};

/// Reads the top level and checks that it ends where it should. Errors: damaged or truncated, a UID is missing.
Result<ObjectSummary> summarize(const DataSet& data_set);

/// Text of a value without the spaces and zeros that pad it.
std::string_view trimmed(std::string_view value) noexcept;

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
