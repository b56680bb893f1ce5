#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar::io {

/// A CT and what its files say about it.
struct CtScan {
  volume::CtGrid grid;
  std::string series_uid;             ///< Empty if the CT is not DICOM, as the next two.
  std::string frame_of_reference;     ///< UID.
  std::string patient_id;             ///< For comparison, never displayed; also empty if the CT is not DICOM.
  std::vector<Vec3> slices_P;         ///< Centres of the first pixels of the slices in the files, along their normal.
  std::vector<std::string> warnings;  ///< Images that were left out, slices that were resampled.
};

/// Reads a 3D CT: NIfTI, NRRD, MHA/MHD, or one DICOM series of a folder and its sub-folders (uncompressed, RLE, JPEG,
/// JPEG-LS, JPEG 2000; the slice step comes from the positions; files that are not DICOM images are ignored). Result in
/// LPS mm, HU rounded to int16; RAS files are converted, mirrored grids re-ordered along k; values below -32768 are
/// padding and become -32768. DICOM slices with gantry tilt (above 0.3 degrees) or uneven steps are resampled linearly
/// onto a straight, even grid; overview images and copies of slices are left out; each with a warning. Errors: no
/// image, truncated, damaged or of an impossible size, a single slice, 4D, NaN or infinite voxels, values above 32767,
/// sheared axes; in a folder more than one CT series, a gap above 10 mm or three times the usual distance in uneven
/// slices, two slices at one position, frames without a place, colour or deflated files; a single DICOM file. `series`
/// selects one of several DICOM series by number (list_dicom_series) or UID; if it is empty, the only series or the
/// only CT series with more than one slice is read. A non-empty `series` for a file is an error.
Result<CtScan> read_ct_scan(const std::filesystem::path& path, const std::string& series = {},
                            const std::vector<std::string>& preferred = {});
/// The same without what the files say; warnings are lost.
Result<volume::CtGrid> read_ct(const std::filesystem::path& path, const std::string& series = {});

/// Reads a label volume or a mask: the same formats, .seg.nrrd without overlaps and DICOM mask series included. Values
/// are whole numbers 0..255, anything else is refused.
Result<volume::LabelGrid> read_labels(const std::filesystem::path& path);

/// Reads an ultrasound volume: the same formats, gray levels 0..255, rounded with a warning if they have fractions.
/// Warnings are appended. Errors: values outside, a volume of fractions from 0 to 1.
Result<volume::LabelGrid> read_gray_levels(const std::filesystem::path& path, std::vector<std::string>& warnings);

/// Endings of image files in lower case, for file dialogs: ".nii", ".nii.gz" …
std::vector<std::string_view> image_endings();
/// File name without folder and image ending: "liver" of "a/liver.nii.gz".
std::string name_without_ending(const std::filesystem::path& path);

/// Reads a float volume (distance fields, float NIfTI). NaN and infinity are errors.
Result<volume::FloatGrid> read_float(const std::filesystem::path& path);

/// Writes the format of the ending: .nrrd .nii .nii.gz .mha; compressed if the format supports it; completely or not at
/// all. Requires free disk space for the uncompressed image.
Status write_image(const volume::CtGrid& grid, const std::filesystem::path& path);
Status write_image(const volume::LabelGrid& grid, const std::filesystem::path& path);
Status write_image(const volume::FloatGrid& grid, const std::filesystem::path& path);

/// Texts in the header of an image: properties of a volume apart from its voxels, such as the fan of an ultrasound
/// sweep.
using ImageFields = std::map<std::string, std::string>;

/// Writes an image with fields, in .nrrd only ("key:=value"). Keys of letters, digits, "_", "-" and "."; values of
/// printable text in one line, else exit status 2.
Status write_image(const volume::CtGrid& grid, const std::filesystem::path& path, const ImageFields& fields);
Status write_image(const volume::LabelGrid& grid, const std::filesystem::path& path, const ImageFields& fields);
Status write_image(const volume::FloatGrid& grid, const std::filesystem::path& path, const ImageFields& fields);

/// The fields of a .nrrd; none for other formats. The values are untrusted: check them.
Result<ImageFields> read_image_fields(const std::filesystem::path& path);

}  // namespace trocar::io
