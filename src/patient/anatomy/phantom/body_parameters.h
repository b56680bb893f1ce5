#pragma once

#include <string>

namespace trocar::anatomy::phantom {

enum class Sex : unsigned char { kFemale, kMale };

/// What a procedural patient is made from, besides the seed. Defaults: the reference body of data/phantoms.
struct BodyParameters {
  Sex sex = Sex::kMale;
  double height_cm = 172.0;  ///< Range 145..200. The whole body is scaled by it.
  double weight_kg = 72.0;   ///< Range 38..160. With the height it gives the thickness of the subcutaneous fat.
  double age_years =
      50.0;  ///< Range 18..95. Older: lower discs, less dense bone, more fat in muscles, calcified aorta.
  double scoliosis_deg = 0.0;           ///< Cobb angle, -45..45; positive: convex to the patient's left.
  double flexion = 0.0;                 ///< 0 lying flat .. 1 back bent as for a lumbar puncture.
  double interspace_share = 1.0;        ///< Height of the spaces between the spinous processes, 0.45..1.2 of the usual.
  double liver_size = 1.0;              ///< Factor on the liver's lengths, 0.8..1.15.
  double lesion_diameter_mm = 21.0;     ///< Of the first lesion, 6..45.
  double lesion_contrast_hu = -40.0;    ///< First lesion against liver, -80..40.
  double ascites_ml = 0.0;              ///< Free fluid, 0..8000.
  double duct_diameter_mm = 4.0;        ///< Of the common hepatic duct: 4 is normal, 8 and more dilated; 2..16.
  bool has_obstruction = false;         ///< A tumour closes the bile duct at `obstruction_share` of its length.
  double obstruction_share = 0.8;       ///< 0 at the hilum .. 1 at the papilla.
  std::string phase = "portal-venous";  ///< Contrast phase: native, arterial or portal-venous.
  double noise_hu = 14.0;               ///< Noise in the middle of the body, 3..40: the dose.

  double body_mass_index() const { return weight_kg / (height_cm * height_cm * 1e-4); }
};

}  // namespace trocar::anatomy::phantom
