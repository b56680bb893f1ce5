#pragma once

namespace trocar::scene {

/// Amount of a plan that the views of a case show.
enum class Guidance {
  kNone,    ///< No guidance, and no lesions of the segmentation: the trainee must find them in the images.
  kTarget,  ///< The target and the entry zone.
  kPath,    ///< Also the expert's path between them.
};

}  // namespace trocar::scene
