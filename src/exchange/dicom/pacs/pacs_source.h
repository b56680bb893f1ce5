#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::dicom {

/// Interval of polling whether a retrieval was cancelled while it waits for the PACS.
inline constexpr int kPoll_ms = 200;

/// A study as the PACS lists it. Texts come from the PACS: printable, in UTF-8.
struct StudyEntry {
  std::string uid;
  std::string date;  ///< "20240131", or empty.
  std::string description;
  std::string modalities;  ///< "CT\\SEG", or empty.
};

/// A series of a study as the PACS lists it.
struct SeriesEntry {
  std::string uid;
  std::string modality;  ///< "CT", "SEG", "RTSTRUCT" …
  std::string description;
  std::optional<int> number;          ///< SeriesNumber
  std::optional<std::size_t> images;  ///< Empty: the PACS does not count them.
};

/// Receives objects while they arrive, one after the other. The first error ends the retrieval.
class ObjectSink {
 public:
  virtual ~ObjectSink() = default;

  virtual Status begin() = 0;
  virtual Status append(std::string_view bytes) = 0;
  /// `transfer_syntax`: UID of the encoding if only a data set was sent; empty: a whole DICOM file was sent.
  virtual Status end(const std::string& transfer_syntax) = 0;
  virtual bool is_cancelled() const = 0;  ///< Polled while waiting for the PACS.
};

/// A PACS. Every call connects anew. Errors of all calls: the PACS refuses, closes the connection, sends nothing for
/// the time limit, or sends what the protocol does not allow.
class PacsSource {
 public:
  virtual ~PacsSource() = default;

  virtual Result<std::vector<StudyEntry>> list_studies(const std::string& patient_id) = 0;
  /// Empty if the PACS has no such study.
  virtual Result<std::vector<SeriesEntry>> list_series(const std::string& study_uid) = 0;
  /// Every object of the series, in any order.
  virtual Status retrieve(const std::string& study_uid, const std::string& series_uid, ObjectSink& sink) = 0;
};

}  // namespace trocar::dicom
