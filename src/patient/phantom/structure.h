#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "core/result.h"
#include "phantom/phantom_data.h"
#include "phantom/shapes.h"
#include "phantom/torso.h"

namespace trocar::phantom {

inline constexpr float kAirHu = -1000.0F;

/// HU and label of a point.
struct Paint {
  float hu = kAirHu;
  std::uint8_t label = 0;
};

/// Drawing of borders: as wide as a voxel (partial volume).
struct Brush {
  float blur_mm = 1.0F;
  /// Share 0..1 of a voxel that lies inside a surface at this distance.
  float cover(float distance) const { return smooth_step(-0.6F * blur_mm, 0.6F * blur_mm, -distance); }
};

/// One structure to draw. Later structures cover earlier ones.
struct Structure {
  std::string name;                             ///< Its main label, for clearances ("rib_cage" for all ribs).
  Box bounds;                                   ///< Nothing is painted outside.
  std::function<float(const Place&)> distance;  ///< mm, negative inside; slope within kSteepness.
  std::function<Paint(const Place&, float distance, const Brush&)> paint;
};

/// Parts of the reference body: the upper abdomen from T9 to L4, and the torso from T8 to the sacrum.
Box upper_abdomen_box();
Box torso_box(const AbdomenData& data, const BodyParameters& body, std::uint64_t seed);

/// The anatomy of one seed: all data of the patient except the voxels.
struct Anatomy {
  /// `box`: part of the reference body (mm, P) in which places are asked for.
  Anatomy(std::uint64_t seed_, AbdomenData data_, anatomy::KnownStructures known_, const BodyParameters& body_ = {},
          const Box& box = upper_abdomen_box());
  Anatomy(const Anatomy&) = delete;  // the structures refer to the data and the noise
  Anatomy& operator=(const Anatomy&) = delete;

  AbdomenData data;
  anatomy::KnownStructures known;
  BodyParameters body;
  anatomy::Posture posture = anatomy::Posture::kSupine;
  std::uint64_t seed;
  Torso torso;
  ValueNoise noise;
  std::deque<Structure> structures;  ///< References to them stay valid when others are added.
  anatomy::LabelTable label_table;

  /// Size of the patient, 1 for the reference body in whose coordinates the structures are given.
  float scale() const { return static_cast<float>(body.height_cm / kReferenceHeight_cm); }
  /// The label's number; the label is added when it is new. 0 for an unknown name, which check_labels reports.
  std::uint8_t label(std::string_view name);
  /// Error: the first name given to label() that is no known structure.
  Status check_labels() const;
  /// Random numbers of one organ: a change in one organ does not change the others.
  Random random(std::string_view organ) const;
  const Structure& find(std::string_view name) const;
  /// HU that the body's contrast phase adds to a label's.
  float phase_hu(std::string_view label) const;
  /// Label of the structure that is visible at a place of the reference body; 0 outside.
  std::uint8_t label_at(const Place& place) const;
  /// Point of P that the warp maps to q.
  Vec3f unwarped(const Vec3f& q) const;
  void add(Structure structure) { structures.push_back(std::move(structure)); }
  /// A structure of one label with HU that varies slowly around `hu` (texture_hu, features of texture_mm).
  void add_plain(std::string name, const Box& bounds, std::function<float(const Place&)> distance, float hu,
                 float texture_hu = 0.0F, float texture_mm = 12.0F);

 private:
  std::string unknown_label_;
};

/// Suffix of a label: "_right" for the sign -1, "_left" for 1.
std::string side_of(float sign);

/// A centre moved by up to spread_mm along each axis.
Vec3f varied(Random& random, const Vec3f& centre, float spread_mm);

/// Bounds of a structure that may be anywhere.
Box whole_box();
/// Bounds of a shape given around q, the warped place.
Box warped(const Box& box);

// What free fluid does to bowel and organs: the share 0..1 of the bowel that floats, how far and where to.
float floating_share(const BodyParameters& body);
float floating_mm(const BodyParameters& body);
Vec3f floating_direction(const Anatomy& anatomy);
/// Signed distance to the mesentery, which holds floating loops together.
float mesentery_distance(const Anatomy& anatomy, const Place& place);

// Parts, in the order in which they are painted.
void add_trunk(Anatomy& anatomy);   ///< Fat, muscles of the wall, cavity, diaphragm.
void add_thorax(Anatomy& anatomy);  ///< Lungs, mediastinum, heart, oesophagus.
void add_bowel(Anatomy& anatomy);   ///< Small bowel, colon, duodenum.
void add_stomach(Anatomy& anatomy);
void add_spleen(Anatomy& anatomy);
void add_pancreas(Anatomy& anatomy);
void add_pelvic_organs(Anatomy& anatomy);  ///< Bladder and uterus.
void add_kidneys(Anatomy& anatomy);        ///< With fat around them and the adrenal glands.
void add_liver(Anatomy& anatomy);          ///< With gallbladder.
/// Where the gallbladder begins, a warped place.
Vec3f gallbladder_neck(const Anatomy& anatomy);
void add_great_vessels(Anatomy& anatomy);  ///< Aorta, vena cava and their branches.
void add_back_muscles(Anatomy& anatomy);
void add_skeleton(Anatomy& anatomy);
void add_epidural_veins(Anatomy& anatomy);  ///< Venous plexus in front of the dural sac.

}  // namespace trocar::phantom
