#pragma once

#include <string>
#include <string_view>

#include "motion/motion_model.h"

namespace trocar::motion {

/// Text of motion.toml, a motion model in a patient folder without its displacements and its border, which are volumes
/// beside it. Numbers are restored to the bit.
std::string to_toml(const MotionModel& model);

/// What such a text says.
struct MotionDescription {
  MotionParts parts;  ///< Without displacements and border.
  std::string hash;   ///< Of the whole model.
};
/// Reads it; `name` names it in messages. Errors: not a motion model, an unknown key, another format.
Result<MotionDescription> parse_motion(std::string_view text, const std::string& name);

/// All displacements as one volume for a file: x, y and z of a mode, then of the next one, stacked along k on the
/// lattice.
volume::FloatGrid stack_modes(const MotionParts& parts);
/// Takes lattice and displacements from such a volume. Error: it does not have the displacements of all modes.
Status unstack_modes(const volume::FloatGrid& stack, MotionParts& parts, const std::string& name);

/// Hash of a model: 32 hexadecimal digits. Independent of the patient's content_hash: sessions that were recorded
/// before a patient had a model stay valid.
std::string hash_motion(const MotionParts& parts);

}  // namespace trocar::motion
