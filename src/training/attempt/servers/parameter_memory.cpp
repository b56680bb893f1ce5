#include "attempt/servers/parameter_memory.h"

namespace trocar::attempt {

void ParameterMemory::apply(const link::SetParameters& message) {
  const bool has_table = !message.tissues_toml.empty();
  if (has_table) all_.tissues_toml = message.tissues_toml;
  if (has_table || message.tissues) all_.tissues = message.tissues;
  if (!message.force_model.empty()) all_.force_model = message.force_model;
  if (message.coupling_stiffness_n_per_mm) all_.coupling_stiffness_n_per_mm = message.coupling_stiffness_n_per_mm;
  if (message.coupling_damping_ns_per_mm) all_.coupling_damping_ns_per_mm = message.coupling_damping_ns_per_mm;
  if (message.motion) all_.motion = message.motion;
  if (message.has_bending) all_.has_bending = message.has_bending;
}

}  // namespace trocar::attempt
