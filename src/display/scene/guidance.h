#pragma once

namespace trocar::scene {

/// How much of a plan the views of a case give away.
enum class Guidance {
  kNone,    ///< Nothing, and lesions of the segmentation neither: they are to be found in the pictures.
  kTarget,  ///< The target and where the needle may enter.
  kPath,    ///< The expert's path between them, too.
};

}  // namespace trocar::scene
