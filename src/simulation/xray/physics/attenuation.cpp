#include "xray/physics/attenuation.h"

#include <xraylib/xraylib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace trocar::xray {
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
