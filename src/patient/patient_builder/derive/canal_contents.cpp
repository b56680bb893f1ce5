#include <algorithm>
#include <cmath>
#include <optional>

#include "patient_builder/derive/detail/canal.h"

namespace trocar::patient_builder::detail {
namespace {

// Thickness of the ligamentum flavum by the vertebra above: mean of 350 adults, L2-L3, L3-L4, L4-L5, L5-S1
// (doi 10.5603/FM.a2021.0120). Above L2 assumed thinner.
constexpr double kLumbarFlavumMm[] = {3.19, 3.38, 3.71, 3.64};
constexpr double kUpperFlavumMm = 3.0;
// Posterior epidural space in the midline between lumbar laminae: 3 to 6 mm (about 6 mm at L2-L3: Senac 2019; 6.9 +- 4
// mm between loss of resistance and CSF: Bevacqua et al., Reg Anesth 1996, 21:456). The sac leaves at least this much
// free.
constexpr double kEpiduralMm = 3.0;
constexpr double kEpiduralSideMm = 8.0;  // assumed: from here on outwards the sac touches the flavum
constexpr double kEpiduralDeepestMm = 12.0;
// Fat has -190 to -30 HU (Kvist et al., Am J Clin Nutr 1988, 48:1351), ligament and muscle up to about 60 HU: a voxel
// above 30 HU has less than a fifth of fat, or bone in it (docs/physics.md, N2). It is not called fat.
constexpr std::int16_t kMostFatHu = 30;
// Sac without a label of cord or canal, and the cord in it above the conus. Half sizes, assumed: a lumbar sac is about
// 14 mm deep and 17 mm wide, the cord at T12 about 8 x 9 mm.
constexpr double kSacHalfDepthMm = 7.0;
constexpr double kSacHalfWidthMm = 8.5;
constexpr double kSacToBodyMm = 1.0;  // posterior longitudinal ligament
constexpr double kSacToPedicleMm = 1.5;
constexpr double kCordHalfDepthMm = 4.0;
constexpr double kCordHalfWidthMm = 4.5;
constexpr double kConusMm = 20.0;  // length of the cone at the cord's end
constexpr double kNearestBodyMm = 16.0;
constexpr double kVeinsMm = 4.0;  // assumed: depth of the anterior venous plexus, at most

double flavum_mm(std::uint8_t above) {
  const int n = above - (kL1 + 1);
  return n >= 0 && n < 4 ? kLumbarFlavumMm[n] : kUpperFlavumMm;
}

/// Centroids along k of labelled vertebrae.
double middle_k(const DerivedLabels& labels, std::uint8_t id) {
  double sum = 0.0, count = 0.0;
  for_each_in(labels.geometry(), labels.boxes().box[id], [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
    if (labels.at(n) != id) return;
    sum += static_cast<double>(ijk[2]);
    count += 1.0;
  });
  return sum / std::max(count, 1.0);
}

/// Index k of the cord's end, in most adults at L1-L2: the middle of L1 and L2. Below all slices if only higher
/// vertebrae are labelled, above all slices if only lower ones are.
double conus_k(const DerivedLabels& labels, const SpineLabels& spine) {
  constexpr double kL1ToConusMm = 15.0;
  const std::uint8_t l1 = spine.id_of[kL1], l2 = spine.id_of[kL1 + 1];
  if (l1 != 0 && l2 != 0) return 0.5 * (middle_k(labels, l1) + middle_k(labels, l2));
  const double shift = kL1ToConusMm / labels.geometry().spacing_mm.z();
  if (l1 != 0) return middle_k(labels, l1) - shift;
  if (l2 != 0) return middle_k(labels, l2) + shift;
  for (std::uint8_t place = 1; place < kL1; ++place)
    if (spine.id_of[place] != 0) return -1e6;
  return 1e6;
}

/// The sac in a slice: an ellipse.
struct Ellipse {
  double i = 0.0, j = 0.0, half_i = 0.0, half_j = 0.0;  ///< In voxels.
  bool contains(double at_i, double at_j) const noexcept {
    return half_i > 0.0 && half_j > 0.0 && std::pow((at_i - i) / half_i, 2) + std::pow((at_j - j) / half_j, 2) <= 1.0;
  }
};

class CanalContents {
 public:
  CanalContents(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal, const PosteriorWall& wall)
      : labels_(labels), spine_(spine), canal_(canal), wall_(wall), conus_k_(conus_k(labels, spine)) {}

  void add_sac() {
    sac_ = labels_.add("dural_sac");
    if (canal_.cord != 0) {
      divide_labelled_sac();
    } else {
      add_elliptic_sac();
    }
  }

  void add_flavum() {
    const std::uint8_t flavum = labels_.add("ligamentum_flavum");
    for_each_cell([&](std::int64_t i, std::int64_t k, const PosteriorWall::Cell& c, const CanalSlice&) {
      if (!c.is_gap()) return;
      const auto first = static_cast<std::int64_t>(std::ceil(c.face_j));
      const double end = c.face_j + flavum_mm(c.above) * wall_.slant(i, k) / spacing().y();
      for (std::int64_t j = first; j == first || static_cast<double>(j) < end; ++j) paint(i, j, k, flavum);
    });
  }

  /// Soft tissue between the sac and the posterior wall that can be fat by its HU. The rest is no muscle either: voxels
  /// that are partly ligament or bone.
  void add_epidural_fat() {
    const std::uint8_t fat = labels_.add("epidural_fat");
    const std::uint8_t other = labels_.find_or_add("soft_tissue");
    for_each_cell([&](std::int64_t i, std::int64_t k, const PosteriorWall::Cell& c, const CanalSlice& slice) {
      const double room_mm = kEpiduralMm * (1.0 - offset_mm(i, slice) / kEpiduralSideMm);
      const bool is_free = c.is_gap() && c.above >= kL1 && room_mm > 0.0;
      for (auto j = static_cast<std::int64_t>(std::ceil(c.face_j)) - 1; contains(i, j, k); --j) {
        const double depth_mm = (c.face_j - static_cast<double>(j)) * spacing().y();
        const std::size_t n = labels_.geometry().offset({i, j, k});
        const std::uint8_t id = labels_.at(n);
        const bool can_be_fat = labels_.patient().ct.voxels[n] <= kMostFatHu;
        if (is_sac(id) && is_free && depth_mm < room_mm) {
          if (can_be_fat) labels_.replace(n, fat);
        } else if (labels_.is_soft(id) && depth_mm <= kEpiduralDeepestMm && static_cast<double>(j) > slice.j) {
          labels_.paint(n, can_be_fat ? fat : other);
        } else {
          break;
        }
      }
    });
  }

  /// Soft tissue between the sac and the vertebral bodies: the anterior venous plexus.
  void add_epidural_veins() {
    const std::uint8_t veins = labels_.add("epidural_veins");
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      const CanalSlice* slice = canal_.at(k);
      if (slice == nullptr) continue;
      const double half = slice->half_width_mm / spacing().x();
      for (auto i = static_cast<std::int64_t>(std::ceil(slice->i - half)); static_cast<double>(i) <= slice->i + half;
           ++i)
        paint_before_sac(i, static_cast<std::int64_t>(std::lround(slice->j)), k, veins);
    }
  }

 private:
  /// The column in front of the sac's middle, from the sac to the next hard tissue.
  void paint_before_sac(std::int64_t i, std::int64_t middle_j, std::int64_t k, std::uint8_t veins) {
    const auto most = static_cast<std::int64_t>(std::max(1.0, kVeinsMm / spacing().y()));
    std::int64_t painted = 0;
    for (std::int64_t j = middle_j; contains(i, j, k) && painted < most; --j) {
      const std::uint8_t id = labels_.at(labels_.geometry().offset({i, j, k}));
      if (is_canal_content(id)) continue;
      if (!labels_.is_soft(id)) return;
      paint(i, j, k, veins);
      ++painted;
    }
  }
  bool is_canal_content(std::uint8_t id) const noexcept {
    return is_sac(id) || labels_.has_tissue(id, "csf") || labels_.has_tissue(id, "nerve");
  }
  const Vec3& spacing() const noexcept { return labels_.geometry().spacing_mm; }
  bool contains(std::int64_t i, std::int64_t j, std::int64_t k) const { return labels_.geometry().contains({i, j, k}); }
  bool is_sac(std::uint8_t id) const noexcept { return id != 0 && (id == sac_ || id == canal_.cord); }
  double offset_mm(std::int64_t i, const CanalSlice& slice) const {
    return std::abs(static_cast<double>(i) - slice.i) * spacing().x();
  }
  void paint(std::int64_t i, std::int64_t j, std::int64_t k, std::uint8_t id) {
    if (contains(i, j, k)) labels_.paint(labels_.geometry().offset({i, j, k}), id);
  }

  template <class Visit>
  void for_each_cell(Visit&& visit) {
    for (std::int64_t k = wall_.first_k(); k <= wall_.last_k(); ++k) {
      const CanalSlice* slice = canal_.at(k);
      if (slice == nullptr) continue;
      for (std::int64_t i = wall_.first_i(); i <= wall_.last_i(); ++i)
        if (const PosteriorWall::Cell& c = wall_.at(i, k); c.is_known()) visit(i, k, c, *slice);
    }
  }

  /// The cord in a slice: full size above its conical end, nothing below it.
  Ellipse cord_at(std::int64_t k, double i, double j) const {
    const double above_mm = (static_cast<double>(k) - conus_k_) * spacing().z();
    const double size = std::clamp(above_mm / kConusMm, 0.0, 1.0);
    return {i, j, size * kCordHalfWidthMm / spacing().x(), size * kCordHalfDepthMm / spacing().y()};
  }

  /// A label "spinal_cord" of TotalSegmentator contains the sac: only its middle above the conus stays cord.
  void divide_labelled_sac() {
    for_each_in(labels_.geometry(), labels_.boxes().box[canal_.cord],
                [&](std::size_t n, std::size_t, const volume::Index3& ijk) {
                  if (labels_.at(n) != canal_.cord) return;
                  const CanalSlice* slice = canal_.at(ijk[2]);
                  if (slice == nullptr) return;
                  const Ellipse cord = cord_at(ijk[2], slice->i, slice->j);
                  if (!cord.contains(static_cast<double>(ijk[0]), static_cast<double>(ijk[1])))
                    labels_.replace(n, sac_);
                });
  }

  /// Index j of the border of the vertebral body in front of the canal.
  std::optional<double> body_j(const CanalSlice& slice, std::int64_t k) const {
    const auto i = static_cast<std::int64_t>(std::lround(slice.i));
    const auto start = static_cast<std::int64_t>(std::lround(slice.j));
    const auto steps = static_cast<std::int64_t>(kNearestBodyMm / spacing().y());
    for (std::int64_t j = start; j >= std::max<std::int64_t>(0, start - steps); --j)
      if (spine_.place[labels_.at(labels_.geometry().offset({i, j, k}))] != 0) return static_cast<double>(j) + 0.5;
    return std::nullopt;
  }

  void add_elliptic_sac() {
    const std::uint8_t cord = labels_.is_labelled("spinal_cord") ? std::uint8_t{0} : labels_.add("spinal_cord");
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      const CanalSlice* slice = canal_.at(k);
      if (slice == nullptr) continue;
      const Ellipse sac = sac_at(*slice, k);
      const Ellipse inner = cord_at(k, sac.i, sac.j);
      for (auto j = static_cast<std::int64_t>(sac.j - sac.half_j);
           j <= static_cast<std::int64_t>(sac.j + sac.half_j) + 1; ++j)
        for (auto i = static_cast<std::int64_t>(sac.i - sac.half_i);
             i <= static_cast<std::int64_t>(sac.i + sac.half_i) + 1; ++i) {
          const double at_i = static_cast<double>(i), at_j = static_cast<double>(j);
          if (!sac.contains(at_i, at_j)) continue;
          paint(i, j, k, cord != 0 && inner.contains(at_i, at_j) ? cord : sac_);
        }
    }
  }

  Ellipse sac_at(const CanalSlice& slice, std::int64_t k) const {
    const auto middle = static_cast<std::int64_t>(std::lround(slice.i));
    const PosteriorWall::Cell& c = wall_.at(middle, k);
    double half_mm = kSacHalfDepthMm, j = slice.j;
    const std::optional<double> body = body_j(slice, k);
    if (body && c.is_known()) {
      const double depth_mm = (c.face_j - *body) * spacing().y();
      const double behind_mm = c.above >= kL1 ? kEpiduralMm : kSacToBodyMm;
      half_mm = std::clamp(0.5 * (depth_mm - kSacToBodyMm - behind_mm), 1.0, kSacHalfDepthMm);
      j = *body + (kSacToBodyMm + half_mm) / spacing().y();
    }
    const double width_mm = std::clamp(slice.half_width_mm - kSacToPedicleMm, 1.0, kSacHalfWidthMm);
    return {slice.i, j, width_mm / spacing().x(), half_mm / spacing().y()};
  }

  DerivedLabels& labels_;
  const SpineLabels& spine_;
  const Canal& canal_;
  const PosteriorWall& wall_;
  double conus_k_;
  std::uint8_t sac_ = 0;
};

}  // namespace

void derive_canal_contents(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                           const PosteriorWall& wall, const DeriveChoice& choice) {
  CanalContents contents(labels, spine, canal, wall);
  const auto is_wanted = [&](const char* name) { return choice.has(name) && !labels.is_labelled(name); };
  if (is_wanted("dural_sac")) contents.add_sac();
  if (is_wanted("ligamentum_flavum")) contents.add_flavum();
  if (is_wanted("epidural_fat")) contents.add_epidural_fat();
  if (is_wanted("epidural_veins")) contents.add_epidural_veins();
}

}  // namespace trocar::patient_builder::detail
