#pragma once

#include "dicom/pacs/detail/harmless_words.h"
#include "dicom/pacs/detail/pseudonyms.h"
#include "dicom/pacs/detail/text_codes.h"

namespace trocar::dicom::detail {

/// What the objects of one fetch are anonymised with.
struct Anonymisation {
  Pseudonyms pseudonyms;
  HarmlessWords words;
  TextCodes codes;  ///< Grows with the texts that are replaced.
};

}  // namespace trocar::dicom::detail
