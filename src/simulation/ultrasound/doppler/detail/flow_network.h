#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "ultrasound/doppler/detail/centreline.h"
#include "ultrasound/doppler/flow_table.h"

namespace trocar::ultrasound::detail {

/// Which tips of the trees are sources of blood: the rule's named ends, or all others. Every tree has a source and a
/// sink. `label` is the vessel's own. docs/physics.md U15.
std::vector<std::vector<bool>> find_sources(const anatomy::VirtualPatient& patient, std::uint8_t label,
                                            const FlowRule& rule, const std::vector<CentrelineTree>& trees);

/// For each node whether blood flows away from the root there. What the tips give and take grows with the cube of
/// their radius (Murray), and is balanced.
std::vector<bool> flows_from_root(const CentrelineTree& tree, const std::vector<bool>& is_source);

}  // namespace trocar::ultrasound::detail
