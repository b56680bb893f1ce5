#pragma once

#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// Start pose of a transducer.
struct TransducerStart {
  ultrasound::Transducer transducer;
  Pose X_PT;                 ///< Pressed onto the skin so that the face touches along its width.
  double depth_mm = 160.0;   ///< Depth of the image: the target's and a third more.
  bool is_in_plane = false;  ///< The path lies in the image plane, the target is seen, the entry is beside the face.
  std::string note;          ///< Reason why it is not in plane; empty if it is.
};

/// Finds the pose of the transducer for a puncture along `path_P` (entry on the skin, target): in the path's plane, the
/// face beside the entry and not under the needle's hub, the target in the fan, with the least bone, gas and lung in
/// front of it, and with as much else visible as possible. It is the best of several planes about the path and places
/// along the skin. If none shows the target: a standard view of it. Errors: the transducers' or views' file.
Result<TransducerStart> find_transducer_start(const anatomy::VirtualPatient& patient, const Segment& path_P);

}  // namespace trocar::cases

namespace trocar::cases::detail {

// A transducer that the program places on the skin before an attempt.
inline constexpr const char* kLesionView = "liver-lesion";
inline constexpr int kLines = 33;         ///< Scanlines of the examined image.
inline constexpr double kSlope_mm = 6.0;  ///< The skin's normal is averaged over a patch of this size.
inline constexpr double kPress_mm = 3.0;  ///< Depth of the face in the skin.
inline constexpr double kTouching = 0.8;  ///< Share of the scanlines that must have contact.

}  // namespace trocar::cases::detail
