#include "bench/haptics/flat_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace trocar::bench {
namespace {

struct TypicalHu {
  std::string_view tissue;
  double hu;
};
constexpr std::array kTypical{
    TypicalHu{"skin", 20},        TypicalHu{"adipose", -100},    TypicalHu{"muscle", 55},
    TypicalHu{"liver", 60},       TypicalHu{"liver_lesion", 45}, TypicalHu{"bone", 700},
    TypicalHu{"cartilage", 150},  TypicalHu{"vessel", 40},       TypicalHu{"bowel", 30},
    TypicalHu{"lung", -800},      TypicalHu{"kidney", 35},       TypicalHu{"spleen", 50},
    TypicalHu{"gallbladder", 10}, TypicalHu{"organ", 40},        TypicalHu{"nerve", 30},
    TypicalHu{"fluid", 5},        TypicalHu{"ligament", 90},     TypicalHu{"ligamentum_flavum", 60},
    TypicalHu{"csf", 5},          TypicalHu{"ascites", 8},       TypicalHu{"peritoneum", 10},
    TypicalHu{"bile_duct", 10},   TypicalHu{"soft_tissue", 30},  TypicalHu{"gas", -1000}};
constexpr double kAirHu = -1000.0;

}  // namespace

link::LoadScene flat_request() {
  link::LoadScene request;
  request.patient = "flat";
  Mat3 R_PW;
  R_PW.col(0) = Vec3::UnitX();
  R_PW.col(1) = -Vec3::UnitY();
  R_PW.col(2) = -Vec3::UnitZ();
  request.X_PW = Pose(R_PW, {0.0, 0.0, 20.0 - request.needle_length_mm});
  return request;
}

double typical_hu(std::string_view tissue) noexcept {
  const auto it =
      std::find_if(kTypical.begin(), kTypical.end(), [&](const TypicalHu& t) { return t.tissue == tissue; });
  return it != kTypical.end() ? it->hu : 40.0;
}

Result<std::shared_ptr<const anatomy::VirtualPatient>> make_flat_patient(const std::vector<FlatLayer>& layers) {
  if (layers.size() > 255)
    return fail(fmt::format("{} layers are too many", layers.size()), "flat patient", "use fewer layers");
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->name = "flat";
  constexpr double kAbove_mm = 20.0;
  volume::GridGeometry geometry;
  geometry.size = {41, 41, 121};
  geometry.origin_P = {-20.0, -20.0, -kAbove_mm};
  patient->ct = volume::CtGrid(geometry, static_cast<std::int16_t>(kAirHu));
  patient->labels = volume::LabelGrid(geometry, 0);
  patient->skin_distance_mm = volume::FloatGrid(geometry, 0.0F);
  std::vector<std::int16_t> hu;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    hu.push_back(static_cast<std::int16_t>(typical_hu(layers[i].tissue)));
    patient->label_table.labels.push_back(
        {static_cast<std::uint8_t>(i + 1), fmt::format("{}_{}", layers[i].tissue, i + 1), layers[i].tissue, {}});
  }
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const double z = static_cast<double>(geometry.index_of(n)[2]) - kAbove_mm;
    patient->skin_distance_mm.voxels[n] = static_cast<float>(-z);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (z < 0.0 || z < layers[i].from_mm) continue;
      patient->labels.voxels[n] = static_cast<std::uint8_t>(i + 1);
      patient->ct.voxels[n] = hu[i];
    }
  }
  return std::shared_ptr<const anatomy::VirtualPatient>(std::move(patient));
}

}  // namespace trocar::bench
