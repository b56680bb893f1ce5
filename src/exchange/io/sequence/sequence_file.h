#pragma once

#include <filesystem>

#include "core/result.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io {

/// Reads a tracked sequence of gray pictures as PLUS and 3D Slicer write it: .igs.mha, .mha or .mhd with
/// Seq_FrameNNNN_ fields, one byte a pixel, plain or compressed. Rows and columns come as UltrasoundImageOrientation
/// MF has them (columns to the marked side, rows away from the face), turned where the file says MN, UF or UN. A
/// transform whose status is not OK is left out, a picture whose ImageStatus is not OK is kept as invalid; without a
/// status both count as OK, without a time it is 0. Errors: another kind of file or pixel, another orientation, fields
/// that are missing, of frames that are not there or no numbers, a transform that is not affine, pixels that end early.
Result<ultrasound::TrackedSequence> read_sequence(const std::filesystem::path& path);

/// Writes .mha (.igs.mha) with the names and fields of PLUS, compressed, whole or not at all. A transform that a frame
/// lacks and others have is written as INVALID. Errors: another ending, no frame, a name that is not "AToB", NaN.
Status write_sequence(const ultrasound::TrackedSequence& sequence, const std::filesystem::path& path);

}  // namespace trocar::io
