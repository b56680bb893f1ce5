#pragma once

#include <array>
#include <vector>

#include "patient_builder/plausibility/detail/directions.h"
#include "patient_builder/plausibility/detail/edge_match.h"
#include "patient_builder/plausibility/judge_anatomy.h"

namespace trocar::patient_builder::detail {

// Whether the labels lie where the CT shows the structures. Each function appends what it finds.

/// Directions that the organs' places contradict: labels that are reversed alone fit the CT when reversed back.
void judge_directions(const std::array<AxisVotes, 3>& votes, const EdgeMatch& edges, const volume::GridGeometry& g,
                      Mirroring mirroring, std::vector<AnatomyFinding>& findings);
/// Labels that fit the CT better elsewhere, or reversed although no organ tells.
void judge_place(const EdgeMatch& edges, const volume::GridGeometry& g, Mirroring mirroring,
                 std::vector<AnatomyFinding>& findings);
/// Single structures that were drawn elsewhere, in a segmentation that fits otherwise.
void judge_single_places(const anatomy::VirtualPatient& patient, const EdgeMatch& edges,
                         std::vector<AnatomyFinding>& findings);

/// Volumes, lengths and shapes of whole organs beyond those of any person, and large organs that a segmentation of many
/// structures lacks although its scan reaches over their place. Both are told, not refused.
void judge_sizes(const volume::LabelGrid& labels, const anatomy::LabelTable& table, const LabelShapes& shapes,
                 std::vector<AnatomyFinding>& findings);

}  // namespace trocar::patient_builder::detail
