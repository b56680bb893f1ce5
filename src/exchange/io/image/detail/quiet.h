#pragma once

#include "core/decimal_point.h"

namespace trocar::io::detail {

/// Around every call of ITK: stops ITK and its NIfTI library from writing to the terminal (a defect of a file is
/// reported once, by our error), and keeps the numbers of its text headers free of the user's locale. Cheap.
/// Thread-safe.
class ItkCall {
 public:
  ItkCall();

 private:
  DecimalPoint decimal_point_;
};

/// Discards standard error of the whole process during the lifetime of this object. The JPEG codecs of GDCM print
/// there, even for valid 12-bit files, as do MetaIO and VNL for damaged headers, and have no option to disable it. Use
/// it only around such calls of milliseconds. Thread-safe.
class MutedStandardError {
 public:
  MutedStandardError();
  ~MutedStandardError();
  MutedStandardError(const MutedStandardError&) = delete;
  MutedStandardError& operator=(const MutedStandardError&) = delete;
};

}  // namespace trocar::io::detail
