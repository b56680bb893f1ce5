#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"
#include "phantom/shapes.h"
#include "phantom/spine_curve.h"

// The numbers of data/phantoms/abdomen.toml: sizes and places of the anatomy in P (mm; angles in rad, in the file in
// degrees). The file describes each of them; comments here only add facts that are not in the names.
namespace trocar::phantom {

/// A number that is drawn anew for each seed.
struct SeedRange {
  double low, high;
  float draw(Random& random) const { return static_cast<float>(random.uniform(low, high)); }
};

/// height * exp(-((x - centre) / width)^2).
struct Hill {
  float height, centre, width;
  float shape(float x) const { return bump(x, centre, width); }
  float at(float x) const { return height * shape(x); }
};

/// From 0 at `from` to 1 at `to`, which may lie below `from`.
struct Transition {
  float from, to;
  float share(float x) const { return smooth_step(from, to, x); }
};

/// From 0 to `height`.
struct Rise {
  float height;
  Transition over;
  float at(float x) const { return height * over.share(x); }
};

/// An ellipse across the z axis.
struct Ellipse {
  float x, y, radius_x, radius_y;
};

using Course = std::vector<Knot>;

struct TorsoData {
  struct Skin {
    Hill waist_z;
    Rise chest_taper_z, chest_depth_z;
    Hill belly_z, spinal_furrow;
    Rise spinal_furrow_chest_z;
    Hill erector, linea_alba, umbilicus;
  };
  struct Fat {
    SeedRange factor;
    float least_mm;
    Transition chest_z;
    Hill flank;
    float flank_chest_share;
    Hill loin;
    Transition loin_z;
    std::array<float, 2> front_mm;  ///< Belly, chest.
    Hill front;                     ///< Height 1.
    Hill umbilicus;
  };
  struct Muscle {
    float least_mm;
    Transition chest_z;
    std::array<float, 2> back_mm;  ///< Belly, chest.
    float back_width;
    std::array<float, 2> lateral_mm;
    Hill lateral;  ///< Height 1.
    float linea_alba_mm, linea_alba_width;
  };
  struct Diaphragm {
    float rim_back_mm;
    Rise rim_side, rim_front;
    float dome_mm;
    SeedRange dome_spread_mm;
    Hill right_dome_x, right_dome_y, left_dome_x, left_dome_y;  ///< The heights of y are 1.
    float rise_mm;
  };
  /// Changes below the belly. Walls are added to the thickness of the muscles.
  struct Pelvis {
    Hill hip_z;
    Rise lower_belly_z;
    Hill buttock_z, buttock;  ///< The height of the second is 1.
    Rise cleft_z;
    Hill hip_fat_z;
    Rise upper_wall_z, lower_wall_z;
    Hill wall;  ///< Height 1.
    Rise back_wall_z;
    float back_wall_width;
    Hill bulge, bulge_z;  ///< Of the belly by free fluid; heights 1.
  };
  SeedRange half_width_mm, half_depth_mm;
  float back_depth_mm;
  float umbilicus_z_mm;
  SeedRange waves_mm;
  Skin skin;
  Fat fat;
  Muscle muscle;
  Pelvis pelvis;
  Diaphragm diaphragm;
};

struct LandmarkData {
  float xiphoid_z_mm, tenth_rib_below_t10_mm;
};

struct SpineData {
  static constexpr std::size_t kLevels = 13;  ///< T5 … L5.
  std::array<float, kLevels> heights_mm;
  float anchor_y_mm;  ///< y of the middle of L3, from where the spine's curve goes up and down.
  std::vector<SpineInclination> inclinations;
  float body_half_width_mm, body_half_depth_mm, body_waist_mm;
  std::array<float, 2> body_hollow;
  float canal_y_mm;
  std::array<float, 2> canal_radii_mm;
  float cord_y_mm;
  std::array<float, 2> cord_radii_mm;
  Transition cord_end_z;
  float disc_half_height_mm;

  /// Position along the spine (mm) of the centre of a vertebral body; level 0 is T5, 7 is T12, 12 is L5. Levels beyond
  /// these give the nearest one.
  float height(int level) const;
};

struct VertebraData {
  float size;
  float half_disc_mm;
  std::vector<Cone> paired;   ///< Processes of the left side.
  std::vector<Cone> spinous;  ///< In the median plane.
};

struct RibData {
  static constexpr int kFirst = 5, kLast = 12;
  struct Neck {
    int first_rib;
    float begin_deg;
    Knot head;
    float tubercle_x_mm, tubercle_share, tubercle_above_mm, tubercle_radius_mm;
    float angle_radius_mm;
  };
  float outward_mm, half_thickness_mm, half_height_mm;
  float begin_deg;
  std::array<float, kLast - kFirst + 1> ends_deg;
  float fall_mm, head_above_mm;
  Neck neck;

  float end_deg(int rib) const { return ends_deg[static_cast<std::size_t>(rib - kFirst)]; }
};

struct CartilageData {
  struct Path {
    int rib;
    float middle_deg, middle_z, end_deg, end_z;
  };
  std::vector<Path> courses;
  std::array<float, 5> radii_mm;
  float sag_mm;
};

struct SternumData {
  float outward_mm;
  float z_mm, half_width_mm, half_height_mm;
  float xiphoid_z_mm, xiphoid_half_width_mm, xiphoid_half_height_mm;
  float half_thickness_mm;
};

struct BackMuscleData {
  struct QuadratusLumborum {
    float x_mm, y_mm;
    std::array<float, 2> upper_radii_mm, wider_mm;
    Transition wider_z;
    float slant, top_z_mm;
  };
  Transition chest_z;
  Ellipse multifidus, outer_lumbar, outer_thoracic;
  Course psoas, crus;
  QuadratusLumborum quadratus_lumborum;
};

struct HeartData {
  SeedRange x_mm;
  float y_mm;
  SeedRange z_mm;
  Vec3f radii_mm;
  Ellipse mediastinum;
};

struct StomachData {
  Course course;
  float radius_spread;
  float fluid_level_y_mm, fluid_level_spread_mm;
};

/// Folds of the mucosa or haustra.
struct Folds {
  float distance_mm, depth_mm;
};

struct DuodenumData {
  Course course;
  Folds folds;
};

struct SmallBowelData {
  Vec3f first, step;
  int columns, layers, rows;
  int first_upper_column;
  float stagger_mm, slant_mm;
  float radius_mm;
  Vec3f spread;
  float radius_spread_mm;
  Folds folds;
};

struct ColonData {
  Course course;
  std::array<std::size_t, 2> hanging_knots;  ///< First and last index into the course.
  float hanging_spread_mm;
  Vec3f spread;
  Folds folds;
};

struct SpleenData {
  Vec3f centre;
  float spread_mm;
  Vec3f radii_mm;
  SeedRange size;
  Vec3f hollow_centre, hollow_radii_mm;
};

struct PancreasData {
  Course course;
  float spread_mm;
};

struct KidneyData {
  Vec3f right_centre, left_centre;
  float spread_mm;
  SeedRange size;
  Vec3f radii_mm;
  Vec3f hilum_centre, hilum_radii_mm;
  Vec3f sinus_centre, sinus_radii_mm;
  Vec3f capsule_centre, capsule_radii_mm;
};

struct AdrenalGlandData {
  Vec3f top;
  Course course;
};

struct LiverData {
  SeedRange size;
  Vec3f right_centre, right_radii_mm;
  SeedRange left_reach_mm;
  Vec3f left_centre, left_radii_mm;
  SeedRange tip_z_mm;
  float tip_x_mm;
  std::array<float, 2> visceral_slope;
  Hill visceral_hollow_x;
  Ellipse spine_space;
  Vec3f porta_centre, porta_radii_mm;
  float fissure_x_mm, fissure_y_mm;
  Vec3f hilum, venous_confluence;
};

struct GallbladderData {
  SeedRange x_mm;
  Course course;
};

struct AortaData {
  Course chest;
  float spine_front_mm;
  Course before_spine;  ///< y: distance in front of the spine.
  std::vector<Course> branches;
};

struct EpigastricData {
  std::vector<std::array<float, 2>> course;  ///< Distance from the midline and z, from the groin upwards.
  float radius_mm, outward_mm;
};

struct BladderData {
  Vec3f centre, radii_mm;
  SeedRange size;
};

struct UterusData {
  Vec3f centre, radii_mm;
  float spread_mm;
};

/// A vein and its branches.
struct VeinData {
  Course course;
  std::vector<Course> branches;
};

struct TreeData {
  Vec3f direction;
  float root_radius_mm, root_share, least_radius_mm;
};

struct BileDuctData {
  std::vector<Vec3f> course;
  Vec3f beside, artery_beside;
  float narrow_radius_mm, tumour_radius_mm;
};

/// HU added in a contrast phase, by the beginning of a label's name; the first match counts.
using PhaseData = std::vector<std::pair<std::string, float>>;

struct LesionData {
  SeedRange gate_deg, gate_z_mm;
  float gate_outward_mm;
  std::array<double, 3> direction_spread;
  SeedRange depth_mm, radius_mm, other_radius_mm;
  float apart_mm, from_hilum_mm, longest_path_mm;
};

struct AbdomenData {
  TorsoData torso;
  LandmarkData landmarks;
  SpineData spine;
  VertebraData thoracic_vertebra, lumbar_vertebra;
  RibData ribs;
  CartilageData cartilages;
  SternumData sternum;
  BackMuscleData back_muscles;
  HeartData heart;
  Course oesophagus;
  StomachData stomach;
  DuodenumData duodenum;
  SmallBowelData small_bowel;
  ColonData colon;
  SpleenData spleen;
  PancreasData pancreas;
  KidneyData kidneys;
  AdrenalGlandData adrenal_glands;
  LiverData liver;
  GallbladderData gallbladder;
  AortaData aorta;
  VeinData vena_cava;
  EpigastricData epigastric;
  BladderData bladder;
  UterusData uterus;
  VeinData portal_vein;  ///< The main course ends at the hilum.
  TreeData portal_tree, hepatic_tree;
  BileDuctData bile_duct;
  LesionData lesions;
  PhaseData native, arterial;
};

/// File in the data folder.
inline constexpr std::string_view kAbdomenFile = "phantoms/abdomen.toml";

/// Reads data/phantoms/abdomen.toml. Every key must be there, and no other. Errors name file and key: a missing file or
/// key, a wrong count, a number that is not finite or out of range.
Result<AbdomenData> load_abdomen_data(const std::filesystem::path& path);

}  // namespace trocar::phantom
