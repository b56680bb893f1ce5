#include "attempt/record/other_forces.h"

#include <fmt/format.h>

#include "haptics/force_version.h"

namespace trocar::attempt {

std::string other_forces_note(const storage::SessionInfo& info) {
  if (info.force_version == haptics::kForceVersion) return {};
  return fmt::format(
      "recorded with version {} of the forces, this program has version {}: forces computed anew differ from the "
      "recorded ones",
      info.force_version, haptics::kForceVersion);
}

}  // namespace trocar::attempt
