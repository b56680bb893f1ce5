#include "ultrasound/engine/artefacts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

namespace trocar::ultrasound {
namespace {

constexpr std::array<std::pair<std::string_view, bool Artefacts::*>, 10> kArtefactNames = {{
    {"attenuation", &Artefacts::attenuation},
    {"downshift", &Artefacts::downshift},
    {"reverberation", &Artefacts::reverberation},
    {"mirror", &Artefacts::mirror},
    {"refraction", &Artefacts::refraction},
    {"range-distortion", &Artefacts::range_distortion},
    {"side-lobes", &Artefacts::side_lobes},
    {"contact-loss", &Artefacts::contact_loss},
    {"clutter", &Artefacts::clutter},
    {"noise", &Artefacts::noise},
}};

}  // namespace

std::vector<std::string_view> artefact_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, is_on] : kArtefactNames) names.push_back(name);
  return names;
}

Status switch_off(Artefacts& artefacts, std::string_view name) {
  for (const auto& [known, is_on] : kArtefactNames) {
    if (known == name || name == "all") artefacts.*is_on = false;
    if (known == name) return {};
  }
  if (name == "all") return {};
  return fail_usage(fmt::format("there is no artefact \"{}\"", name), "--off",
                    fmt::format("known are: {}, all", fmt::join(artefact_names(), ", ")));
}

}  // namespace trocar::ultrasound
