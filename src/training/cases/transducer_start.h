#pragma once

#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/segment.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cases {

/// Where a transducer begins.
struct TransducerStart {
  ultrasound::Transducer transducer;
  Pose X_PT;                 ///< Pressed onto the skin so that the face touches along its width.
  double depth_mm = 160.0;   ///< Of the picture: the target and a third more.
  bool is_in_plane = false;  ///< The path lies in the image plane, the target is seen, the entry is beside the face.
  std::string note;          ///< Why not; empty when it is.
};

/// Holds the transducer for a puncture along `path_P` (entry on the skin, target): in the path's plane, the face beside
/// the entry and not under the needle's hub, with the target in the fan, least bone, gas and lung before it, and as
/// much else as can be seen. Of planes about the path and places along the skin the best; where none shows the target,
/// a standard view of it. Errors: the transducers' or views' file.
Result<TransducerStart> find_transducer_start(const anatomy::VirtualPatient& patient, const Segment& path_P);

}  // namespace trocar::cases
