#include "xray/physics/materials.h"

#include <fmt/format.h>
#include <xraylib/xraylib.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "config/toml.h"

namespace trocar::xray {
namespace {

constexpr double kFitFrom_kev = 30.0, kFitTo_kev = 120.0, kFitStep_kev = 2.0;
constexpr double kCt_kev = 70.0;  ///< Effective energy of a CT of 120 kV inside a body (assumed: 60..80).
constexpr double kCorticalBone_g_per_cm3 = 1.85;
constexpr double kNothing_hu = -1000.0;

double water_cm2_per_g(double kev) {
  return attenuation_cm2_per_g(composition_of(Basis::kWater), kev);
}

double hu_of(std::span<const ElementShare> elements, double density_g_per_cm3, double kev) {
  return 1000.0 * (density_g_per_cm3 * attenuation_cm2_per_g(elements, kev) / water_cm2_per_g(kev) - 1.0);
}

Result<XrayMaterial> read_material(const std::string& name, const config::TomlTable& row, double kev) {
  TROCAR_TRY_STATUS(row.check_keys({"density_g_per_cm3", "elements", "source"}));
  TROCAR_TRY_STATUS(row.string("source"));
  XrayMaterial material;
  material.name = name;
  TROCAR_TRY(material.density_g_per_cm3, row.number("density_g_per_cm3", {1e-4, 25.0}));
  TROCAR_TRY(const config::TomlTable elements, row.table("elements"));
  double sum = 0.0;
  for (const std::string& symbol : elements.keys()) {
    const int number = atomic_number_of(symbol);
    if (number == 0) return fail(fmt::format("there is no element \"{}\"", symbol), elements.where(), "correct it");
    TROCAR_TRY(const double share, elements.number(symbol, {0.0, 1.0}));
    material.elements.push_back({number, share});
    sum += share;
  }
  constexpr double kRounding = 0.002;  // compositions are printed with three digits
  if (std::abs(sum - 1.0) > kRounding)
    return fail(fmt::format("the elements' shares have the sum {:.4f}", sum), elements.where(), "correct them to 1");
  material.shares = fit_basis(material.elements);
  material.hu = hu_of(material.elements, material.density_g_per_cm3, kev);
  return material;
}

Result<HuCurve> make_curve(const std::vector<std::string>& names, const std::vector<XrayMaterial>& materials,
                           const std::string& where) {
  std::vector<HuCurve::Knot> knots;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(materials, name, &XrayMaterial::name);
    if (found == materials.end())
      return fail(fmt::format("there is no material \"{}\"", name), where, "name a table of [materials]");
    if (!knots.empty() && knots.back().hu >= found->hu)
      return fail(fmt::format("\"{}\" has {:.0f} HU, not more than the material before it", name, found->hu), where,
                  "list the materials by rising HU");
    const double density = found->density_g_per_cm3;
    knots.push_back({found->hu, {density * found->shares.water, density * found->shares.bone}});
  }
  if (knots.empty()) return fail("a tissue has no material", where, "name at least one");
  return HuCurve(std::move(knots));
}

}  // namespace

BasisShares fit_basis(std::span<const ElementShare> material) {
  // Normal equations of water * w + bone * b = 1 at all energies, with coefficients relative to the material's.
  double ww = 0.0, wb = 0.0, bb = 0.0, w1 = 0.0, b1 = 0.0;
  const auto relative = [&](Basis basis, double kev) {
    return attenuation_cm2_per_g(composition_of(basis), kev) / attenuation_cm2_per_g(material, kev);
  };
  for (double kev = kFitFrom_kev; kev <= kFitTo_kev; kev += kFitStep_kev) {
    const double w = relative(Basis::kWater, kev), b = relative(Basis::kBone, kev);
    ww += w * w;
    wb += w * b;
    bb += b * b;
    w1 += w;
    b1 += b;
  }
  const double determinant = ww * bb - wb * wb;
  BasisShares shares{(w1 * bb - wb * b1) / determinant, (ww * b1 - w1 * wb) / determinant, 0.0};
  for (double kev = kFitFrom_kev; kev <= kFitTo_kev; kev += kFitStep_kev) {
    const double sum = shares.water * relative(Basis::kWater, kev) + shares.bone * relative(Basis::kBone, kev);
    shares.worst_error = std::max(shares.worst_error, std::abs(sum - 1.0));
  }
  return shares;
}

BasisDensity HuCurve::at(double hu) const noexcept {
  const auto scaled = [&](const Knot& knot) -> BasisDensity {
    const double factor = std::max(0.0, (hu - kNothing_hu) / (knot.hu - kNothing_hu));
    return {factor * knot.density.water, factor * knot.density.bone};
  };
  if (!(hu > knots_.front().hu)) return scaled(knots_.front());
  for (std::size_t n = 1; n < knots_.size(); ++n) {
    const Knot &a = knots_[n - 1], &b = knots_[n];
    if (hu > b.hu) continue;
    const double share = (hu - a.hu) / (b.hu - a.hu);
    return {a.density.water + share * (b.density.water - a.density.water),
            a.density.bone + share * (b.density.bone - a.density.bone)};
  }
  return scaled(knots_.back());
}

HuCurve water_and_bone_curve() {
  const double bone_hu = hu_of(composition_of(Basis::kBone), kCorticalBone_g_per_cm3, kCt_kev);
  return HuCurve({{0.0, {1.0, 0.0}}, {bone_hu, {0.0, kCorticalBone_g_per_cm3}}});
}

const HuCurve& XrayMaterials::curve_of(std::string_view tissue) const noexcept {
  const auto found = tissues.find(tissue);
  return found == tissues.end() ? unlabelled : found->second;
}

Result<XrayMaterials> load_xray_materials(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(document.check_keys({"effective_kev", "materials", "default", "tissues"}));
  TROCAR_TRY(const config::SourcedNumber kev, config::read_sourced_number(document, "effective_kev", {40.0, 120.0}));
  XrayMaterials all;
  TROCAR_TRY(const config::TomlTable materials, document.table("materials"));
  for (const std::string& name : materials.keys()) {
    TROCAR_TRY(const config::TomlTable row, materials.table(name));
    TROCAR_TRY(XrayMaterial material, read_material(name, row, kev.value));
    all.materials.push_back(std::move(material));
  }
  TROCAR_TRY(const config::TomlTable unlabelled, document.table("default"));
  TROCAR_TRY_STATUS(unlabelled.check_keys({"mixture"}));
  TROCAR_TRY(const std::vector<std::string> mixture, unlabelled.strings("mixture"));
  TROCAR_TRY(all.unlabelled, make_curve(mixture, all.materials, unlabelled.where()));
  TROCAR_TRY(const config::TomlTable tissues, document.table("tissues"));
  for (const std::string& tissue : tissues.keys()) {
    TROCAR_TRY(const std::vector<std::string> names, tissues.strings(tissue));
    TROCAR_TRY(HuCurve curve, make_curve(names, all.materials, tissues.where() + "." + tissue));
    all.tissues.insert_or_assign(tissue, std::move(curve));
  }
  return all;
}

namespace {

constexpr std::array<ElementShare, 2> kWaterElements{{{1, 0.111898}, {8, 0.888102}}};
constexpr std::array<ElementShare, 9> kBoneElements{{{1, 0.047234},
                                                     {6, 0.144330},
                                                     {7, 0.041990},
                                                     {8, 0.446096},
                                                     {12, 0.002200},
                                                     {15, 0.104970},
                                                     {16, 0.003150},
                                                     {20, 0.209930},
                                                     {30, 0.000100}}};
constexpr std::array<ElementShare, 1> kIodineElements{{{53, 1.0}}};
constexpr std::array<ElementShare, 3> kSteelElements{{{24, 0.18}, {26, 0.72}, {28, 0.10}}};
constexpr std::array<ElementShare, 1> kAluminiumElements{{{13, 1.0}}};

constexpr double kLowest_kev = 5.0, kHighest_kev = 200.0;

struct TableRow {
  double kev, cm2_per_g;
};
constexpr std::array<TableRow, 11> kAirAbsorption{{{10.0, 4.742},
                                                   {15.0, 1.334},
                                                   {20.0, 0.5389},
                                                   {30.0, 0.1537},
                                                   {40.0, 0.06833},
                                                   {50.0, 0.04098},
                                                   {60.0, 0.03041},
                                                   {80.0, 0.02407},
                                                   {100.0, 0.02325},
                                                   {150.0, 0.02496},
                                                   {200.0, 0.02672}}};

}  // namespace

double attenuation_cm2_per_g(std::span<const ElementShare> material, double kev) {
  if (!(kev >= kLowest_kev && kev <= kHighest_kev)) return 0.0;
  double sum = 0.0;
  for (const ElementShare& element : material) sum += element.share * CS_Total(element.atomic_number, kev, nullptr);
  return sum;
}

double air_energy_absorption_cm2_per_g(double kev) noexcept {
  const double at = std::clamp(kev, kAirAbsorption.front().kev, kAirAbsorption.back().kev);
  std::size_t interval = 0;
  while (interval + 2 < kAirAbsorption.size() && at > kAirAbsorption[interval + 1].kev) ++interval;
  // Lagrange's cubic through the four rows about it.
  const std::size_t first = std::clamp<std::size_t>(interval, 1, kAirAbsorption.size() - 3) - 1;
  double sum = 0.0;
  for (std::size_t a = first; a < first + 4; ++a) {
    double factor = std::log(kAirAbsorption[a].cm2_per_g);
    for (std::size_t b = first; b < first + 4; ++b)
      if (b != a)
        factor *= std::log(at / kAirAbsorption[b].kev) / std::log(kAirAbsorption[a].kev / kAirAbsorption[b].kev);
    sum += factor;
  }
  return std::exp(sum);
}

std::span<const ElementShare> composition_of(Basis basis) noexcept {
  switch (basis) {
    case Basis::kWater:
      return kWaterElements;
    case Basis::kBone:
      return kBoneElements;
    case Basis::kIodine:
      return kIodineElements;
    case Basis::kSteel:
      return kSteelElements;
  }
  return {};
}

std::span<const ElementShare> aluminium() noexcept {
  return kAluminiumElements;
}

int atomic_number_of(const std::string& symbol) noexcept {
  return SymbolToAtomicNumber(symbol.c_str(), nullptr);
}

}  // namespace trocar::xray
