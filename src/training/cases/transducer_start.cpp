#include "cases/transducer_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/files/folders.h"
#include "ultrasound/probe/probe_contact.h"
#include "ultrasound/probe/probe_placement.h"
#include "volume/sampling.h"

namespace trocar::cases {
namespace {

constexpr const char* kTransducer = "C5-2";  // of the abdomen's view
constexpr int kPlanes = 12;                  ///< Around the path: every 15 degrees.
constexpr double kBesideFace_mm = 8.0;       ///< Free skin between the end of the face and the entry.
constexpr double kFarthestSlide_mm = 24.0;   ///< Additional distance along the skin.
constexpr double kSlide_mm = 4.0;
constexpr double kWayStep_mm = 2.0;
constexpr int kGasBelow_hu = -300;  ///< As in src/patient/anatomy; gas in bowel is labelled bowel.
constexpr double kBehindTarget = 1.33;
constexpr double kDepthStep_mm = 10.0;
constexpr double kLeastDepth_mm = 80.0;
constexpr double kTiltedSkin = radians(35.0);          ///< Maximum tilt of the plane relative to the skin.
constexpr std::array kSeen{0.3, 0.5, 0.7, 0.85, 1.0};  ///< Checked points of the path.

// Weights of the cost of a pose; assumed, chosen on the embedded patients.
constexpr double kTargetCost = 4.0;
constexpr double kDarkCost = 1.0;  ///< All of the fan behind ribs or gas; between ribs is better.
constexpr double kTiltCost = 2.0;  ///< Per rad between plane and skin's normal.
constexpr double kContactCost = 1.5;
constexpr double kUnderHubCost = 1.5;
constexpr double kFarCost = 0.5;

struct Place {
  Pose X_PT;
  double cost = std::numeric_limits<double>::infinity();
  double target_depth_mm = 0.0;
  bool shows_target = false;
};

class InPlane {
 public:
  InPlane(const anatomy::VirtualPatient& patient, const Segment& path_P, const ultrasound::Transducer& transducer)
      : patient_(patient),
        path_P_(path_P),
        scan_(ultrasound::make_scan_geometry(transducer, transducer.greatest_depth_mm, detail::kLines, 16)) {
    half_face_mm_ = std::abs(scan_.line_origin(0.0).x());
    for (const anatomy::Label& label : patient.label_table.labels)
      hides_[label.id] =
          label.tissue == "bone" || label.tissue == "cartilage" || label.tissue == "lung" || label.tissue == "gas";
  }

  Place best() const {
    const Vec3 d_P = path_P_.direction();
    const Vec3 across_P = d_P.unitOrthogonal();
    Place best;
    for (int i = 0; i < kPlanes; ++i) {
      const Vec3 plane_P = Eigen::AngleAxisd(std::numbers::pi * i / kPlanes, d_P) * across_P;
      for (const double side : {-1.0, 1.0}) {
        for (double far_mm = 0.0; far_mm <= kFarthestSlide_mm; far_mm += kSlide_mm) {
          const Place place = try_place(side * plane_P, far_mm);
          if (place.cost < best.cost) best = place;
        }
      }
    }
    return best;
  }

 private:
  double skin_mm(const Vec3& p_P) const { return volume::sample_linear(patient_.skin_distance_mm, p_P); }
  Vec3 outwards(const Vec3& p_P) const {
    Vec3 slope;
    for (int a = 0; a < 3; ++a) {
      const Vec3 step = detail::kSlope_mm * Vec3::Unit(a);
      slope[a] = skin_mm(p_P + step) - skin_mm(p_P - step);
    }
    return slope.norm() > 1e-9 ? Vec3(slope.normalized()) : Vec3(-path_P_.direction());
  }

  /// `plane_P`: normal of the image plane; its sign selects the side of the entry for the face.
  Place try_place(const Vec3& plane_P, double far_mm) const {
    Place place;
    const Vec3 n_P = outwards(path_P_.a);
    const Vec3 out_P = (n_P - n_P.dot(plane_P) * plane_P).normalized();
    const Vec3 along_P = plane_P.cross(out_P);
    Vec3 at_P = path_P_.a + (half_face_mm_ + kBesideFace_mm + far_mm) * along_P;
    for (int round = 0; round < 12; ++round) at_P -= skin_mm(at_P) * out_P;  // stays in the plane
    if (std::abs(skin_mm(at_P)) > 1.0 || !contains(at_P)) return place;

    const Vec3 normal_P = outwards(at_P);
    const double tilt = std::asin(std::min(1.0, std::abs(normal_P.dot(plane_P))));
    const Vec3 y_P = -(normal_P - normal_P.dot(plane_P) * plane_P).normalized();
    const ultrasound::FaceFit fit =
        ultrasound::fit_face(patient_.skin_distance_mm, scan_, at_P, oriented(y_P, plane_P), detail::kPress_mm);
    place.X_PT = fit.X_PT;
    const Vec3 entry_T = fit.X_PT.inverse() * path_P_.a;
    if (std::abs(entry_T.x()) < half_face_mm_ + 0.5 * kBesideFace_mm) return place;

    double hidden = 0.0;
    for (const double share : kSeen) hidden += hidden_share(fit.X_PT, path_P_.at(share)) / kSeen.size();
    const double target_hidden = hidden_share(fit.X_PT, path_P_.b);
    const double under_hub = std::max(0.0, -path_P_.direction().dot(along_P));
    place.target_depth_mm = polar(fit.X_PT, path_P_.b).depth_mm;
    place.cost = kTargetCost * target_hidden + hidden + kDarkCost * dark_share(fit.X_PT, place.target_depth_mm) +
                 kTiltCost * tilt + kContactCost * (1.0 - fit.touching) + kUnderHubCost * under_hub +
                 kFarCost * far_mm / kFarthestSlide_mm;
    place.shows_target = target_hidden == 0.0 && tilt < kTiltedSkin && fit.touching > detail::kTouching;
    return place;
  }

  /// +x to the head if the plane is along the body, else to the patient's right.
  static Mat3 oriented(const Vec3& y_P, const Vec3& plane_P) {
    Vec3 x_P = y_P.cross(plane_P).normalized();
    const bool is_along_body = std::abs(x_P.z()) > 0.5;
    if (is_along_body ? x_P.z() < 0.0 : x_P.x() > 0.0) x_P = -x_P;
    Mat3 R_PT;
    R_PT << x_P, y_P, x_P.cross(y_P);
    return R_PT;
  }

  bool contains(const Vec3& p_P) const {
    return volume::sample_nearest<std::int16_t>(patient_.ct, p_P, std::numeric_limits<std::int16_t>::min()) !=
           std::numeric_limits<std::int16_t>::min();
  }

  ultrasound::Polar polar(const Pose& X_PT, const Vec3& p_P) const {
    const Vec3 p_T = X_PT.inverse() * p_P;
    return scan_.to_polar({p_T.x(), p_T.y()});
  }

  /// 0: visible; 1: outside the fan; between: the share of the way that is behind bone or gas.
  double hidden_share(const Pose& X_PT, const Vec3& p_P) const {
    const ultrasound::Polar at = polar(X_PT, p_P);
    if (!(at.line >= 0.0 && at.line <= scan_.lines - 1 && at.depth_mm > 0.0 && at.depth_mm < scan_.depth_mm))
      return 1.0;
    return hidden_share(X_PT, at);
  }

  /// Mean of all scanlines down to a depth.
  double dark_share(const Pose& X_PT, double depth_mm) const {
    double sum = 0.0;
    for (int line = 0; line < scan_.lines; ++line)
      sum += hidden_share(X_PT, ultrasound::Polar{static_cast<double>(line), depth_mm});
    return sum / scan_.lines;
  }

  /// The share of the line to a point of the fan that is behind bone or gas.
  double hidden_share(const Pose& X_PT, const ultrasound::Polar& at) const {
    const ultrasound::Vec2 from = scan_.line_origin(at.line);
    const ultrasound::Vec2 way = scan_.line_direction(at.line);
    const Vec3 from_P = X_PT * Vec3(from.x(), from.y(), 0.0);
    const Vec3 way_P = X_PT.R() * Vec3(way.x(), way.y(), 0.0);
    for (double gone_mm = 0.0; gone_mm < at.depth_mm; gone_mm += kWayStep_mm) {
      const Vec3 q_P = from_P + gone_mm * way_P;
      if (skin_mm(q_P) > 0.0) continue;
      const auto label = volume::sample_nearest<std::uint8_t>(patient_.labels, q_P, 0);
      if (hides_[label] || volume::sample_nearest<std::int16_t>(patient_.ct, q_P, 0) < kGasBelow_hu)
        return 1.0 - gone_mm / at.depth_mm;
    }
    return 0.0;
  }

  const anatomy::VirtualPatient& patient_;
  const Segment& path_P_;
  ultrasound::ScanGeometry scan_;
  double half_face_mm_ = 0.0;
  std::array<bool, 256> hides_{};
};

/// The lesion's view if the patient has one, else his first view.
std::optional<Pose> standard_view(const anatomy::VirtualPatient& patient,
                                  const std::vector<ultrasound::ProbeView>& views,
                                  const ultrasound::Transducer& transducer, std::string& title) {
  std::vector<std::string> names = ultrasound::possible_views(patient, views);
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return name == detail::kLesionView; });
  for (const std::string& name : names) {
    const auto view = ultrasound::choose_view(patient, views, name);
    if (!view) continue;
    if (const auto placed = ultrasound::place_probe(patient, *view, transducer)) {
      title = view->title;
      return placed->X_PT;
    }
  }
  return std::nullopt;
}

}  // namespace

Result<TransducerStart> find_transducer_start(const anatomy::VirtualPatient& patient, const Segment& path_P) {
  TransducerStart start;
  TROCAR_TRY(start.transducer, ultrasound::load_transducer(data_dir() / "transducers.toml", kTransducer));
  TROCAR_TRY(const std::vector<ultrasound::ProbeView> views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  const Place place = InPlane(patient, path_P, start.transducer).best();
  start.X_PT = place.X_PT;
  start.is_in_plane = place.shows_target;
  double deepest_mm = place.target_depth_mm;
  if (!place.shows_target) {
    std::string title;
    const auto X_PT = standard_view(patient, views, start.transducer, title);
    if (!X_PT && !std::isfinite(place.cost))
      return fail("no position for the transducer on the skin near the entry", patient.name,
                  "place the transducer by hand");
    if (X_PT) start.X_PT = *X_PT;
    deepest_mm = (path_P.b - start.X_PT.p()).norm();
    start.note = X_PT ? "no view along the whole path near the entry; the transducer starts with: " + title
                      : "the path is only partly visible: bone, lung or gas is in front of it";
  }
  start.depth_mm = std::clamp(std::ceil(kBehindTarget * deepest_mm / kDepthStep_mm) * kDepthStep_mm, kLeastDepth_mm,
                              start.transducer.greatest_depth_mm);
  return start;
}

}  // namespace trocar::cases
