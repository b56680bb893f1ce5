#pragma once

#include "case_builder/case_draft.h"
#include "core/files/data_dir.h"
#include "tasks/needle.h"
#include "tasks/test/box_patient.h"

namespace trocar::testing {

inline Task liver_biopsy() {
  return *load_task(data_dir() / "tasks", "liver-biopsy");
}
inline Needle biopsy_gun() {
  return *load_needle(data_dir() / "needles.toml", "biopsy-18g");
}
inline TissueTable shipped_tissues() {
  return *load_tissue_table(data_dir() / "tissues.toml");
}

/// A draft of the patient made of shapes, as an import would give it, without surfaces.
inline CaseDraft made_draft(const BoxPatient& box = {}) {
  auto imported = std::make_shared<ImportedPatient>();
  imported->patient = box.make();
  imported->patient.content_hash = hash_patient(imported->patient);
  imported->statistics = label_statistics(imported->patient);
  imported->source = "box";
  CaseDraft draft;
  draft.name = "box";
  draft.description = "a patient made of shapes";
  draft.provenance = {"made for a test"};
  draft.label_table = imported->patient.label_table;
  draft.base = draft.task = liver_biopsy();
  draft.imported = std::move(imported);
  return draft;
}

/// From the right side straight to the lesion, the notch's middle in it.
inline Segment good_path(const Needle& needle) {
  const Vec3 lesion_P = BoxPatient{}.lesion_centre_P;
  return {{-100.0, lesion_P.y(), lesion_P.z()}, lesion_P - needle.notch_middle_mm() * Vec3::UnitX()};
}

}  // namespace trocar::testing
