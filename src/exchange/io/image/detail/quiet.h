#pragma once

namespace trocar::io::detail {

/// Stops ITK and its NIfTI library from writing to the terminal: what is wrong with a file is said once, by our error.
/// Cheap after the first call; safe from any thread.
void silence_itk();

/// While one lives, standard error of the whole process goes nowhere: the JPEG codecs inside GDCM print there, even for
/// sound 12-bit files, as do MetaIO and VNL for damaged headers, and cannot be told not to. Only around such calls of
/// milliseconds; safe from several threads at once.
class MutedStandardError {
 public:
  MutedStandardError();
  ~MutedStandardError();
  MutedStandardError(const MutedStandardError&) = delete;
  MutedStandardError& operator=(const MutedStandardError&) = delete;
};

}  // namespace trocar::io::detail
