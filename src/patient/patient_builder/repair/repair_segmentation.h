#pragma once

#include <vector>

#include "anatomy/patient.h"

namespace trocar::patient_builder {

/// Repairs errors that segmentation programs are known for (README.md), in the labels of a segmentation before fat and
/// muscle are found: exchanged sides, parts with the name of the other side, islands far from the structure, holes,
/// ribs in pieces or cut off before the spine. Voxels of removed islands get 0. The volumes have their axes in the
/// order of P. Returns one finding for each repair, with its place.
std::vector<anatomy::Finding> repair_segmentation(const volume::CtGrid& ct, volume::LabelGrid& labels,
                                                  anatomy::LabelTable& table);

/// What looks like an error of the segmentation and is not repaired: a vertebra much larger or smaller than its
/// neighbours, vertebrae out of order, a structure in several large parts, a rib that ends before the spine, left and
/// right exchanged in the whole image.
std::vector<anatomy::Finding> segmentation_findings(const anatomy::VirtualPatient& patient);

}  // namespace trocar::patient_builder
