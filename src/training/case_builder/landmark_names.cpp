#include "case_builder/landmark_names.h"

#include <array>

namespace trocar::case_builder {

std::span<const std::string_view> landmark_names() noexcept {
  static constexpr std::array<std::string_view, 25> kNames{"suprasternal notch",
                                                           "xiphoid process",
                                                           "right costal margin, mid-clavicular line",
                                                           "left costal margin, mid-clavicular line",
                                                           "right mid-axillary line, eighth intercostal space",
                                                           "right mid-axillary line, tenth rib",
                                                           "umbilicus",
                                                           "right anterior superior iliac spine",
                                                           "left anterior superior iliac spine",
                                                           "right iliac crest",
                                                           "left iliac crest",
                                                           "pubic symphysis",
                                                           "spinous process C7",
                                                           "spinous process T12",
                                                           "spinous process L1",
                                                           "spinous process L2",
                                                           "spinous process L3",
                                                           "spinous process L4",
                                                           "spinous process L5",
                                                           "interspinous space L3/L4",
                                                           "interspinous space L4/L5",
                                                           "right twelfth rib",
                                                           "left twelfth rib",
                                                           "right posterior superior iliac spine",
                                                           "left posterior superior iliac spine"};
  return kNames;
}

}  // namespace trocar::case_builder
