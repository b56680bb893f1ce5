#pragma once

#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "image/image.h"

namespace trocar::report {

/// Axial, coronal and sagittal slice of 120 mm around the place of a finding, side by side, with the outlines of the
/// labels and a ring at the place. Precondition: it has a place.
image::RgbImage finding_picture(const anatomy::VirtualPatient& patient, const anatomy::Finding& finding);

/// The check of a patient as one self-contained HTML page: tasks, findings and repairs, with a picture of each place.
struct PatientCheck {
  std::vector<std::string> tasks;  ///< One line each.
  std::vector<anatomy::Finding> findings;
};
std::string patient_report(const anatomy::VirtualPatient& patient, const PatientCheck& check);

}  // namespace trocar::report
