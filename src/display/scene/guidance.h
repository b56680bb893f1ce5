#pragma once

namespace trocar::scene {

/// Amount of a plan that the views of a case show.
enum class Guidance {
  kNone,    ///< No guidance, and no lesions of the segmentation: the trainee must find them in the images.
  kTarget,  ///< The target and where the needle may enter.
  kPath,    ///< The expert's path between them, too.
};

}  // namespace trocar::scene
