#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/result.h"
#include "io/dicom/detail/dicom_slice.h"

namespace trocar::io::detail {

/// Checks slices in the order along their normal: those of one acquisition or time point (DicomSlice::acquisition) lie
/// together, as in a scan in steps. Error: they alternate with those of another one, as phases of a contrast agent or
/// of the breath do when their places lie between each other. A single slice that was scanned again is no error.
Status check_acquisitions(const std::vector<DicomSlice>& slices, const std::filesystem::path& folder);

/// The same by the pixels, for series that do not number their acquisitions: every slice resembles the next but one
/// more than the next. `hu` has the pixels of all slices, `pixels` of each.
Status check_alternation(std::span<const std::int16_t> hu, std::size_t pixels, const std::filesystem::path& folder);

}  // namespace trocar::io::detail
