#pragma once

#include <filesystem>

#include "core/result.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io {

/// Reads a tracked sequence of gray images in the format of PLUS and 3D Slicer: .igs.mha, .mha or .mhd with
/// Seq_FrameNNNN_ fields, one byte per pixel, plain or compressed. Rows and columns have UltrasoundImageOrientation MF
/// (columns to the marked side, rows away from the face); images in MN, UF or UN are flipped. A transform whose status
/// is not OK is skipped; an image whose ImageStatus is not OK is stored as invalid. A missing status means OK, a
/// missing time means 0. Errors: another type of file or pixel, another orientation, missing fields, fields of missing
/// frames, fields that are not numbers, a transform that is not affine, too few pixels.
Result<ultrasound::TrackedSequence> read_sequence(const std::filesystem::path& path);

/// True for a MetaImage file whose images have poses of their own. Errors: as read_sequence for the file and its
/// header.
Result<bool> is_sequence(const std::filesystem::path& path);

/// Writes .mha (.igs.mha) with the names and fields of PLUS, compressed, completely or not at all. A transform that
/// only some frames have is written as INVALID for the others. Errors: another ending, no frame, a name that is not
/// "AToB", NaN.
Status write_sequence(const ultrasound::TrackedSequence& sequence, const std::filesystem::path& path);

}  // namespace trocar::io
