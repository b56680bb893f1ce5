#include "cases/neutral_start.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cases/transducer_start.h"
#include "core/files/folders.h"
#include "ultrasound/probe/probe_contact.h"
#include "ultrasound/probe/probe_placement.h"
#include "volume/sampling.h"

namespace trocar::cases {
namespace {

constexpr double kPastTarget_mm = 25.0;      ///< Minimum distance of the needle's line from the target.
constexpr double kBesideZone_mm = 20.0;      ///< From the edge of the task's own entry zone.
constexpr double kFarthestPlace_mm = 160.0;  ///< From the entry; farther ones only if there is no other.
constexpr double kPatientsEnd_mm = 20.0;     ///< Minimum extent of the body in the image towards head and feet.
constexpr double kLeastUp = 0.3;             ///< Of the skin's unit normal, towards the working side.
constexpr double kBetween_mm = 10.0;         ///< Distance of the examined positions, and
constexpr double kFarthestLevel_mm = 150.0;  ///< maximum distance from the organ's level.
constexpr double kStep_mm = 2.0;
constexpr double kShaftStep_mm = 10.0;
constexpr double kShaftFree_mm = 8.0;  ///< Between shaft and skin.
/// From the front, without the plan's part of the liver; then all others in the file's order.
constexpr std::array kFirstViews{"aorta-transverse", "aorta"};

struct Skin {
  Vec3 p_P;
  Vec3 out_P;  ///< Unit.
};

/// The skin on the working side, from the organ's level towards head and feet.
class UpperSkin {
 public:
  UpperSkin(const Case& the_case, const Vec3& entry_P) : skin_mm_(the_case.patient->skin_distance_mm) {
    const volume::GridGeometry& grid = skin_mm_.geometry;
    for (int corner = 0; corner < 8; ++corner) {
      const volume::Index3 far{grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1};
      Vec3 index = Vec3::Zero();
      for (int a = 0; a < 3; ++a)
        if ((corner >> a) & 1) index[a] = static_cast<double>(far[static_cast<std::size_t>(a)]);
      bounds_P_.extend(grid.to_mm(index));
    }
    up_P_ = -Vec3::UnitY();
    if (outwards(entry_P).y() > 0.5) up_P_ = Vec3::UnitY();  // the entry is at the back
    find_places(organ_level_mm(the_case));
  }

  /// Sorted by the distance from the centre of the organ's level.
  const std::vector<Skin>& places() const noexcept { return places_; }
  double mm(const Vec3& p_P) const { return volume::sample_linear(skin_mm_, p_P); }
  bool is_on_side(const Vec3& out_P) const { return out_P.dot(up_P_) >= kLeastUp; }

  Vec3 outwards(const Vec3& p_P) const {
    Vec3 slope;
    for (int a = 0; a < 3; ++a) {
      const Vec3 step = detail::kSlope_mm * Vec3::Unit(a);
      slope[a] = mm(p_P + step) - mm(p_P - step);
    }
    return slope.norm() > 1e-9 ? Vec3(slope.normalized()) : up_P_;
  }

  bool is_shaft_free(const Skin& place, double length_mm) const {
    for (double s_mm = NeutralStart::kAbove_mm; s_mm < NeutralStart::kAbove_mm + length_mm; s_mm += kShaftStep_mm) {
      const Vec3 q_P = place.p_P + s_mm * place.out_P;
      if (bounds_P_.contains(q_P) && mm(q_P) < kShaftFree_mm) return false;
    }
    return true;
  }

 private:
  /// Of its centre; the entry zone or target if the patient has no such label.
  static double organ_level_mm(const Case& the_case) {
    const volume::LabelGrid& labels = the_case.patient->labels;
    std::array<bool, 256> is_of_organ{};
    for (const anatomy::Label& label : the_case.patient->label_table.labels)
      is_of_organ[label.id] = tasks::is_organ(the_case.task, label);
    double sum_mm = 0.0, count = 0.0;
    constexpr std::size_t kEvery = 61;  // a prime, to avoid alignment with rows and slices
    for (std::size_t n = 0; n < labels.voxels.size(); n += kEvery) {
      if (!is_of_organ[labels.voxels[n]]) continue;
      const volume::Index3 ijk = labels.geometry.index_of(n);
      sum_mm += labels.geometry.centre_mm(ijk).z();
      count += 1.0;
    }
    return count > 0.0 ? sum_mm / count : the_case.plan.line_P.b.z();
  }

  /// First intersection of a vertical line from above with the body.
  std::optional<Skin> below(double x_mm, double z_mm) const {
    const double top_mm = up_P_.y() < 0.0 ? bounds_P_.min().y() : bounds_P_.max().y();
    Vec3 p_P(x_mm, top_mm, z_mm);
    if (mm(p_P) <= 0.0) return std::nullopt;  // the image ends within the body
    for (double gone_mm = 0.0; gone_mm < bounds_P_.sizes().y(); gone_mm += kStep_mm, p_P -= kStep_mm * up_P_) {
      const double distance_mm = mm(p_P);
      if (distance_mm > 0.0) continue;
      const Vec3 skin_P = p_P - distance_mm * outwards(p_P);
      return Skin{skin_P, outwards(skin_P)};
    }
    return std::nullopt;
  }

  void find_places(double level_mm) {
    const double low_mm = std::max(bounds_P_.min().z() + kPatientsEnd_mm, level_mm - kFarthestLevel_mm);
    const double high_mm = std::min(bounds_P_.max().z() - kPatientsEnd_mm, level_mm + kFarthestLevel_mm);
    Vec3 middle_P = Vec3::Zero();
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (double z_mm = low_mm; z_mm <= high_mm; z_mm += kBetween_mm) {
      std::vector<Skin> row;
      for (double x_mm = bounds_P_.min().x(); x_mm <= bounds_P_.max().x(); x_mm += kBetween_mm)
        if (const auto place = below(x_mm, z_mm)) row.push_back(*place);
      if (row.empty()) continue;
      if (std::abs(z_mm - level_mm) < nearest_mm) {
        nearest_mm = std::abs(z_mm - level_mm);
        middle_P = row[row.size() / 2].p_P;
      }
      std::copy_if(row.begin(), row.end(), std::back_inserter(places_),
                   [&](const Skin& place) { return is_on_side(place.out_P); });
    }
    std::stable_sort(places_.begin(), places_.end(), [&](const Skin& a, const Skin& b) {
      return (a.p_P - middle_P).squaredNorm() < (b.p_P - middle_P).squaredNorm();
    });
  }

  const volume::FloatGrid& skin_mm_;
  Eigen::AlignedBox3d bounds_P_;
  Vec3 up_P_;
  std::vector<Skin> places_;
};

bool is_away(const Case& the_case, const Vec3& p_P) {
  const auto& zone = the_case.task.entry_zone;
  return (p_P - the_case.plan.line_P.a).norm() >= NeutralStart::kAway_mm &&
         (!zone || zone->distance_outside_mm(p_P) >= kBesideZone_mm);
}

std::optional<Pose> neutral_needle(const Case& the_case, const UpperSkin& skin, const std::optional<Pose>& X_PT) {
  const Segment& path_P = the_case.plan.line_P;
  const Skin* found = nullptr;
  for (const Skin& place : skin.places()) {
    if (!is_away(the_case, place.p_P) || !skin.is_shaft_free(place, the_case.needle.length_mm)) continue;
    if (distance_to_line_mm(place.p_P, place.out_P, path_P.b) < kPastTarget_mm) continue;
    if (X_PT && (place.p_P - X_PT->p()).norm() < NeutralStart::kApart_mm) continue;
    const bool is_near = (place.p_P - path_P.a).norm() <= kFarthestPlace_mm;
    if (is_near || found == nullptr) found = &place;
    if (is_near) break;
  }
  if (found == nullptr) return std::nullopt;
  return needle_pose(found->p_P + NeutralStart::kAbove_mm * found->out_P, -found->out_P);
}

class NeutralProbe {
 public:
  NeutralProbe(const Case& the_case, const UpperSkin& skin, const ultrasound::Transducer& transducer,
               const Pose& X_PT_planned)
      : case_(the_case), skin_(skin), transducer_(transducer), X_PT_planned_(X_PT_planned) {}

  /// In a view of another structure than the lesion, with its image depth.
  std::optional<std::pair<Pose, double>> in_view(const std::vector<ultrasound::ProbeView>& views) const {
    std::vector<std::string> names(kFirstViews.begin(), kFirstViews.end());
    for (const ultrasound::ProbeView& view : views) names.push_back(view.name);
    const std::vector<std::string> possible = ultrasound::possible_views(*case_.patient, views);
    for (const std::string& name : names) {
      if (name == detail::kLesionView || std::find(possible.begin(), possible.end(), name) == possible.end()) continue;
      const auto view = ultrasound::choose_view(*case_.patient, views, name);
      if (!view) continue;
      const auto placed = ultrasound::place_probe(*case_.patient, *view, transducer_);
      if (!placed || placed->visibility.visible < ultrasound::kEnoughVisible) continue;
      const Pose& X_PT = placed->X_PT;
      if (is_neutral(X_PT.p()) && skin_.is_on_side(-X_PT.R().col(1))) return std::pair(X_PT, view->depth_mm);
    }
    return std::nullopt;
  }

  /// Across the body, at the first position with contact.
  std::optional<Pose> anywhere() const {
    const ultrasound::ScanGeometry scan =
        ultrasound::make_scan_geometry(transducer_, transducer_.greatest_depth_mm, detail::kLines, 16);
    for (const Skin& place : skin_.places()) {
      if (!is_neutral(place.p_P)) continue;
      Mat3 R_PT;
      R_PT.col(1) = -place.out_P;
      R_PT.col(0) = place.out_P.cross(Vec3::UnitZ()).normalized();  // towards the patient's right, seen from the front
      if (R_PT.col(0).x() > 0.0) R_PT.col(0) *= -1.0;
      R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
      const ultrasound::FaceFit fit =
          ultrasound::fit_face(case_.patient->skin_distance_mm, scan, place.p_P, R_PT, detail::kPress_mm);
      if (fit.touching >= detail::kTouching) return fit.X_PT;
    }
    return std::nullopt;
  }

 private:
  bool is_neutral(const Vec3& p_P) const {
    return is_away(case_, p_P) && (p_P - X_PT_planned_.p()).norm() >= NeutralStart::kAway_mm;
  }

  const Case& case_;
  const UpperSkin& skin_;
  const ultrasound::Transducer& transducer_;
  const Pose& X_PT_planned_;
};

}  // namespace

Result<NeutralStart> find_neutral_start(const Case& the_case, const ultrasound::Transducer& transducer,
                                        const Pose& X_PT_planned) {
  TROCAR_TRY(const std::vector<ultrasound::ProbeView> views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  const Segment& path_P = the_case.plan.line_P;
  const UpperSkin skin(the_case, path_P.a);
  const NeutralProbe probe(the_case, skin, transducer, X_PT_planned);
  NeutralStart start;
  std::optional<Pose> X_PT;
  if (const auto view = probe.in_view(views)) {
    X_PT = view->first;
    start.depth_mm = std::min(view->second, transducer.greatest_depth_mm);
  } else {
    X_PT = probe.anywhere();
  }
  const std::optional<Pose> X_PN = neutral_needle(the_case, skin, X_PT);
  start.X_PT = X_PT.value_or(X_PT_planned);
  start.X_PN = X_PN.value_or(needle_pose(path_P.a - NeutralStart::kAbove_mm * path_P.direction(), path_P.direction()));
  if (!X_PN || !X_PT)
    start.note = fmt::format(
        "this patient has no skin far enough from the planned path: {} at the planned position at every level of help",
        X_PN   ? "the transducer begins"
        : X_PT ? "the needle begins"
               : "both tools begin");
  return start;
}

}  // namespace trocar::cases
