#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/detail/stain_site.h"

namespace trocar::xray {

/// Contrast agent outside of ducts and vessels, on an isotropic grid that grows with it. Each voxel belongs to the
/// organ at its centre (a lesion to its organ); nothing passes from one organ to another. In parenchyma and other
/// tissue the injected volume makes a stain: it takes up a share of the medium's room that falls from the tip to an
/// irregular front (detail/stain_site.h), and fades; in fluid and bowel iodine diffuses. docs/physics.md, X14, X15.
class TissueCloud {
 public:
  /// `spacing_mm`: range 1..5; a stain's texture needs 1.5 mm.
  TissueCloud(std::shared_ptr<const anatomy::VirtualPatient> patient, const ContrastTable& table,
              double spacing_mm = 2.5);

  /// Medium of the tissue at a point; nullptr outside of the body and in ducts and vessels.
  const ContrastMedium* medium_at(const Vec3& p_P) const;
  /// True if the organ at a point (or within 5 mm, as for an injection) is fluid or bowel.
  bool is_fluid_near(const Vec3& p_P) const;
  /// Injects into the organ at a point or, if it has no medium there, within 5 mm. The volume for which the organ has
  /// no room is washed away.
  void inject(const Vec3& tip_P, double ml, double iodine_mg_per_ml);
  /// Fading and diffusion.
  void step(double dt_s);

  double iodine_mg() const;
  double fluid_ml() const;  ///< Contrast agent in parenchyma and tissue.
  double washed_away_mg() const { return washed_away_mg_; }
  /// Iodine of the organ with a label (of lesions: their organ).
  double iodine_mg_in(std::uint8_t label) const;
  /// mg/ml, on the part of the grid in which iodine was; nullptr if there is none.
  std::shared_ptr<const volume::FloatGrid> grid_mg_per_ml() const;

 private:
  using Organ = std::uint16_t;  ///< Id of its label, 0: without label, kNoOrgan: no medium.
  static constexpr Organ kNoOrgan = 256;
  using Box = std::array<volume::Index3, 2>;  ///< Both corners are in the box.

  /// The last injection into tissue.
  struct Site {
    Vec3 tip_P = Vec3::Zero();
    Organ organ = 0;
    double front_mm = 0.0;  ///< Reach of the front.
    detail::StainSite way;
  };

  /// A voxel of fluid that may contain iodine.
  struct Mixed {
    volume::Index3 at;
    bool has_spread;  ///< Its neighbours take part, too.
  };

  Organ organ_at(const Vec3& p_P) const;
  Organ organ_near(const Vec3& p_P) const;
  const ContrastMedium& medium_of(Organ organ) const { return media_[medium_of_organ_[organ]]; }
  volume::Index3 seed_of(const Vec3& tip_P, Organ organ);
  void include(const volume::Index3& at);
  void activate(const volume::Index3& at);
  static std::size_t offset_in(const Box& box, const volume::Index3& at);
  std::size_t offset(const volume::Index3& at) const { return offset_in(window_, at); }
  bool expand_site();
  bool is_tract(const volume::Index3& at);
  double wanted_ml(double room_ml, double& ml_per_mm) const;
  double move_front(double room_ml, double ml);
  void link(const volume::Index3& at);
  void add_mixed(const volume::Index3& at);
  void spread();
  void start_site(const Vec3& tip_P, Organ organ);
  void fill(const Vec3& tip_P, Organ organ, double ml, double iodine_mg_per_ml);
  void pour(const Vec3& tip_P, Organ organ, double iodine_mg);
  void fade(double dt_s);
  void diffuse(double dt_s);
  void diffuse_once(double dt_s);

  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::vector<ContrastMedium> media_;
  std::array<std::uint8_t, 256> organ_of_label_{};
  std::array<std::uint8_t, 256> medium_of_organ_{};
  std::array<bool, 256> has_medium_{};  ///< Of labels.
  volume::GridGeometry lattice_;        ///< The whole body.
  Box window_{};                        ///< Part of the lattice that is stored.
  Box active_{};                        ///< Part of the window with iodine.
  std::vector<double> iodine_mg_, fluid_ml_, change_mg_;
  std::vector<Organ> organ_;
  std::vector<volume::Index3> filled_;  ///< Voxels of parenchyma and tissue with contrast agent.
  std::vector<Mixed> mixed_;
  std::vector<std::uint8_t> is_mixed_;
  std::vector<std::array<std::uint32_t, 2>> faces_;  ///< Offsets of neighbours in `mixed_`.
  Site site_;
  bool is_used_ = false;
  double washed_away_mg_ = 0.0;
};

}  // namespace trocar::xray
