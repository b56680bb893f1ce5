#pragma once

#include "anatomy/label_statistics.h"
#include "anatomy/testing/shipped_tissues.h"
#include "case_builder/case_draft.h"
#include "core/files/folders.h"
#include "tasks/needle.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::testing {

/// A draft of the patient made of shapes, as an import would return it, without surfaces.
inline case_builder::CaseDraft made_draft(const BoxPatient& box = {}) {
  auto imported = std::make_shared<case_builder::ImportedPatient>();
  imported->patient = box.make();
  imported->patient.content_hash = anatomy::hash_patient(imported->patient);
  imported->statistics = anatomy::label_statistics(imported->patient);
  imported->source = "box";
  case_builder::CaseDraft draft;
  draft.name = "box";
  draft.description = "a patient made of shapes";
  draft.provenance = {"made for a test"};
  draft.label_table = imported->patient.label_table;
  draft.base = draft.task = liver_biopsy();
  draft.imported = std::move(imported);
  return draft;
}

/// From the right side straight to the lesion, the notch's middle in it.
inline Segment good_path(const tasks::Needle& needle) {
  const Vec3 lesion_P = BoxPatient{}.lesion_centre_P;
  return {{-100.0, lesion_P.y(), lesion_P.z()}, lesion_P - needle.notch_middle_mm() * Vec3::UnitX()};
}

}  // namespace trocar::testing
