#pragma once

#include <string>

#include "core/result.h"
#include "server/stylus_weighing.h"

namespace trocar::server {

/// Reason of a refused weighing and what to do. `device`: its name, for the message. The refusal must not be kNone.
Error weigh_error(const WeighResult& result, const std::string& device);
/// Sentence with the weight, beside that of the preset, the friction, and remarks on horizontal force and lever.
std::string weigh_text(const WeighResult& result, const haptics::DevicePreset& preset);

}  // namespace trocar::server
