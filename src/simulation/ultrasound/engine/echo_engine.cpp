#include "ultrasound/engine/echo_engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace trocar::ultrasound {

Acquisition default_acquisition(const Transducer& transducer) {
  Acquisition acquisition;
  acquisition.depth_mm = transducer.depth_mm;
  acquisition.frequency_mhz = transducer.frequency_mhz;
  acquisition.focus_mm = transducer.focus_mm;
  acquisition.lines = transducer.scanlines;
  return acquisition;
}

double coupled_share(const BasebandFrame& frame) noexcept {
  constexpr float kMost = 0.5F;
  const auto coupled =
      std::count_if(frame.contact.begin(), frame.contact.end(), [](float part) { return part > kMost; });
  return static_cast<double>(coupled) / static_cast<double>(frame.contact.size());
}

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
