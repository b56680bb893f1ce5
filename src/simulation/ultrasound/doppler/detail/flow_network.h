#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "volume/centreline.h"

namespace trocar::ultrasound::detail {

/// Finds the tips of the trees that are sources of blood: the ends that the rule names, or all others. Every tree has a
/// source and a sink. `label` is the vessel's own. docs/physics.md U15.
std::vector<std::vector<bool>> find_sources(const anatomy::VirtualPatient& patient, std::uint8_t label,
                                            const FlowRule& rule, const std::vector<volume::CentrelineTree>& trees);

/// For each node: true if blood flows away from the root there. The flow of a tip is proportional to the cube of its
/// radius (Murray); inflow and outflow are balanced.
std::vector<bool> flows_from_root(const volume::CentrelineTree& tree, const std::vector<bool>& is_source);

}  // namespace trocar::ultrasound::detail
