#include "patient_builder/plausibility/detail/directions.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <string_view>

#include "anatomy/known_structures.h"
#include "core/parallel.h"
#include "patient_builder/detail/label_boxes.h"

namespace trocar::patient_builder::detail {
namespace {

/// Centroid of a group of structures and its volume.
struct GroupPlace {
  Vec3 sum_P = Vec3::Zero();
  double voxels = 0.0;
  Vec3 middle_P() const { return sum_P / voxels; }
};

constexpr double kSmallest_ml = 0.5;

/// The places of structures by the group that they belong to: "liver", "spine", "kidney".
class Places {
 public:
  Places(const LabelShapes& shapes, double voxel_ml, const anatomy::LabelTable& table) : voxel_ml_(voxel_ml) {
    for (const anatomy::Label& label : table.labels) {
      const LabelShape& shape = shapes[label.id];
      if (label.is_derived || shape.voxels == 0.0) continue;
      add(group_of(label), shape);
      if (anatomy::plain_name(label.name) != group_of(label)) add(anatomy::plain_name(label.name), shape);
      if (const int n = vertebra_place(label.name); n > 0) vertebrae_[n] = shape.middle_P;
    }
  }

  /// `name` as in a segmentation, with or without its side, or "spine", "lung", "heart".
  std::optional<Vec3> find(std::string_view name) const {
    const auto found = groups_.find(anatomy::plain_name(name));
    if (found == groups_.end() || found->second.voxels * voxel_ml_ < kSmallest_ml) return std::nullopt;
    return found->second.middle_P();
  }
  /// Middles of the vertebrae from head to feet.
  std::vector<Vec3> vertebrae() const {
    std::vector<Vec3> middles;
    for (const auto& [place, middle_P] : vertebrae_) middles.push_back(middle_P);
    return middles;
  }

 private:
  static std::string group_of(const anatomy::Label& label) {
    std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
    if (vertebra_place(label.name) > 0) return "spine";
    if (plain.starts_with("lung")) return "lung";
    if (plain.starts_with("heart") || plain == "atrium" || plain == "ventricle") return "heart";
    return plain;
  }

  void add(const std::string& group, const LabelShape& shape) {
    GroupPlace& place = groups_[group];
    place.sum_P += shape.middle_P * shape.voxels;
    place.voxels += shape.voxels;
  }

  double voxel_ml_;
  std::map<std::string, GroupPlace, std::less<>> groups_;
  std::map<int, Vec3> vertebrae_;
};

void vote(AxisVotes& votes, double offset_mm, double clear_mm, const std::string& wrong, bool varies = false) {
  if (offset_mm > clear_mm) ++votes.right;
  if (offset_mm >= -clear_mm) return;
  ++votes.wrong;
  votes.wrong_ones.push_back(wrong);
  if (!varies) votes.misplaced.push_back(wrong);
}

/// Organs of one side; `sign` is their side along x of P (left is positive).
struct OneSided {
  std::string_view name;
  double sign;
  double clear_mm;
  bool varies = false;  ///< Lies in the middle or beyond it in some people.
};
constexpr std::array kOneSided{OneSided{"liver", -1, 15},        OneSided{"gallbladder", -1, 10, true},
                               OneSided{"spleen", 1, 15},        OneSided{"stomach", 1, 10, true},
                               OneSided{"heart", 1, 5, true},    OneSided{"duodenum", -1, 10, true},
                               OneSided{"pancreas", 1, 15, true}};

/// Left ones of pairs that lie right of their partners. Only counted against the organs' votes where none of these says
/// that left is left: single exchanged names are repaired (repair/correct_sides).
void vote_pairs(const Places& places, AxisVotes& votes) {
  if (votes.right > 0) return;
  for (const char* name :
       {"kidney", "lung_upper_lobe", "lung_lower_lobe", "adrenal_gland", "hip", "femur", "iliopsoas"}) {
    const auto left = places.find(fmt::format("{}_left", name)), right = places.find(fmt::format("{}_right", name));
    if (left && right)
      vote(votes, left->x() - right->x(), 10.0, fmt::format("{}_left right of {}_right", name, name), true);
  }
}

AxisVotes vote_left_right(const Places& places, double middle_x_P) {
  AxisVotes votes;
  // The spine is in the middle of the body, which is not always in the middle of the CT.
  constexpr double kUnsure_mm = 10.0;
  const auto spine = places.find("spine");
  const double middle = spine ? spine->x() : middle_x_P;
  for (const OneSided& organ : kOneSided)
    if (const auto place = places.find(organ.name))
      vote(votes, organ.sign * (place->x() - middle), organ.clear_mm + (spine ? 0.0 : kUnsure_mm),
           fmt::format("{} on the {}", organ.name, organ.sign > 0.0 ? "right" : "left"), organ.varies);
  const auto aorta = places.find("aorta"), cava = places.find("inferior_vena_cava");
  if (aorta && cava) vote(votes, aorta->x() - cava->x(), 5.0, "aorta right of the inferior vena cava");
  vote_pairs(places, votes);
  return votes;
}

/// Two structures of which one lies clearly before, or above, the other in everybody.
using InOrder = std::pair<const char*, const char*>;

AxisVotes vote_front_back(const Places& places) {
  AxisVotes votes;
  if (const auto spine = places.find("spine")) {
    for (const char* name : {"aorta", "inferior_vena_cava", "liver", "stomach", "pancreas", "small_bowel", "duodenum",
                             "urinary_bladder", "heart", "colon"})
      if (const auto place = places.find(name))
        vote(votes, spine->y() - place->y(), 5.0, fmt::format("{} behind the spine", name));
    if (const auto back = places.find("autochthon"))
      vote(votes, back->y() - spine->y(), 5.0, "back muscles in front of the spine");
  }
  constexpr std::array<InOrder, 6> kBefore{{{"liver", "kidney"},
                                            {"stomach", "kidney"},
                                            {"pancreas", "kidney"},
                                            {"gallbladder", "kidney"},
                                            {"urinary_bladder", "sacrum"},
                                            {"heart", "autochthon"}}};
  for (const auto& [front, behind] : kBefore) {
    const auto before = places.find(front), after = places.find(behind);
    if (before && after) vote(votes, after->y() - before->y(), 15.0, fmt::format("{} behind {}", front, behind), true);
  }
  return votes;
}

AxisVotes vote_up_down(const Places& places) {
  AxisVotes votes;
  const std::vector<Vec3> vertebrae = places.vertebrae();
  for (std::size_t n = 1; n < vertebrae.size(); ++n)
    vote(votes, vertebrae[n - 1].z() - vertebrae[n].z(), 5.0, "vertebrae from feet to head");
  struct Above {
    const char *upper, *lower;
    bool varies = false;
  };
  constexpr std::array<Above, 13> kAbove{{{"lung", "urinary_bladder"},
                                          {"heart", "urinary_bladder"},
                                          {"liver", "urinary_bladder"},
                                          {"spleen", "urinary_bladder"},
                                          {"stomach", "urinary_bladder", true},
                                          {"kidney", "urinary_bladder", true},
                                          {"lung", "kidney"},
                                          {"lung", "liver", true},
                                          {"heart", "liver", true},
                                          {"liver", "kidney", true},
                                          {"spleen", "kidney", true},
                                          {"liver", "femur"},
                                          {"kidney", "femur", true}}};
  for (const Above& pair : kAbove) {
    const auto above = places.find(pair.upper), below = places.find(pair.lower);
    if (above && below)
      vote(votes, above->z() - below->z(), 20.0, fmt::format("{} below {}", pair.upper, pair.lower), pair.varies);
  }
  return votes;
}

/// A transplanted or pelvic kidney says nothing about the image.
void find_low_kidney(const Places& places, AxisVotes& votes) {
  constexpr double kFar_mm = 80.0;
  const auto left = places.find("kidney_left"), right = places.find("kidney_right");
  if (!left || !right || std::abs(left->z() - right->z()) < kFar_mm) return;
  const bool is_left = left->z() < right->z();
  votes.misplaced.push_back(fmt::format("kidney_{} lies {:.0f} mm below the other", is_left ? "left" : "right",
                                        std::abs(left->z() - right->z())));
}

}  // namespace

std::array<AxisVotes, 3> vote_directions(const LabelShapes& shapes, double voxel_ml, const anatomy::LabelTable& table,
                                         double middle_x_P) {
  const Places places(shapes, voxel_ml, table);
  std::array<AxisVotes, 3> votes{vote_left_right(places, middle_x_P), vote_front_back(places), vote_up_down(places)};
  find_low_kidney(places, votes[2]);
  return votes;
}

namespace {

/// Sums over the voxels of a label, in voxels: n, i, j, k, ii, jj, kk, ij, ik, jk.
using Sums = std::array<double, 10>;
using AllSums = std::array<Sums, 256>;

void add_slice(const volume::LabelGrid& labels, std::int64_t k, AllSums& all) {
  const volume::GridGeometry& g = labels.geometry;
  const auto z = static_cast<double>(k);
  std::size_t n = g.offset({0, 0, k});
  for (std::int64_t j = 0; j < g.size[1]; ++j)
    for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
      if (labels.voxels[n] == 0) continue;
      Sums& sum = all[labels.voxels[n]];
      const auto x = static_cast<double>(i), y = static_cast<double>(j);
      const Sums values{1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z};
      for (std::size_t m = 0; m < values.size(); ++m) sum[m] += values[m];
    }
}

LabelShape shape_of(const Sums& sum, const volume::GridGeometry& g) {
  LabelShape shape;
  shape.voxels = sum[0];
  if (sum[0] == 0.0) return shape;
  const Vec3 middle = Vec3(sum[1], sum[2], sum[3]) / sum[0];
  shape.middle_P = g.to_mm(middle);
  Mat3 squares;
  squares << sum[4], sum[7], sum[8], sum[7], sum[5], sum[9], sum[8], sum[9], sum[6];
  // A voxel is not a point: its own moment is a twelfth.
  const Mat3 in_voxels = squares / sum[0] - middle * middle.transpose() + Mat3::Identity() / 12.0;
  const Mat3 spread_mm2 = g.spacing_mm.asDiagonal() * in_voxels * g.spacing_mm.asDiagonal();
  const Vec3 variances = Eigen::SelfAdjointEigenSolver<Mat3>(spread_mm2, Eigen::EigenvaluesOnly).eigenvalues();
  shape.axes_mm = 2.0 * (5.0 * variances.cwiseMax(0.0)).cwiseSqrt();  // a solid ellipsoid's variance is (a/2)^2 / 5
  shape.fullness = sum[0] * g.voxel_volume_mm3() / (std::numbers::pi / 6.0 * shape.axes_mm.prod());
  return shape;
}

}  // namespace

LabelShapes find_label_shapes(const volume::LabelGrid& labels) {
  const volume::GridGeometry& g = labels.geometry;
  // Whole numbers below 2^53: the order in which the parts are added does not matter.
  AllSums all{};
  std::mutex adding;
  parallel_for(static_cast<std::size_t>(g.size[2]), 8, [&](std::size_t first, std::size_t last) {
    const auto part = std::make_unique<AllSums>();
    for (std::size_t k = first; k < last; ++k) add_slice(labels, static_cast<std::int64_t>(k), *part);
    const std::scoped_lock lock(adding);
    for (std::size_t id = 0; id < all.size(); ++id)
      for (std::size_t m = 0; m < all[id].size(); ++m) all[id][m] += (*part)[id][m];
  });
  LabelShapes shapes;
  for (std::size_t id = 1; id < all.size(); ++id) shapes[id] = shape_of(all[id], g);
  return shapes;
}

}  // namespace trocar::patient_builder::detail
