#pragma once

#include <string>
#include <string_view>

#include "motion/motion_model.h"

namespace trocar::motion {

/// Text of motion.toml, the motion model in a patient folder. Numbers are restored to the bit.
std::string to_toml(const MotionModel& model);

/// Reads such a text; `name` names it in messages. Errors: not a motion model, an unknown key, a newer format, and
/// those of MotionModel::make.
Result<std::shared_ptr<const MotionModel>> parse_motion(std::string_view text, const std::string& name);

/// Hash of a model: 32 hexadecimal digits. Independent of the patient's content_hash: sessions that were recorded
/// before a patient had a model stay valid.
std::string hash_motion(const MotionParts& parts);

}  // namespace trocar::motion
