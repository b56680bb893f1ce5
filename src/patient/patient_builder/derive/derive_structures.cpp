#include "patient_builder/derive/derive_structures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "anatomy/known_structures.h"
#include "core/log.h"
#include "patient_builder/derive/detail/canal.h"
#include "patient_builder/derive/detail/derived_labels.h"

namespace trocar::patient_builder {
namespace {

constexpr std::string_view kOfSpine[] = {"dural_sac",      "ligamentum_flavum",     "epidural_fat",
                                         "epidural_veins", "interspinous_ligament", "supraspinous_ligament"};

void derive_spine(detail::DerivedLabels& labels, const DeriveChoice& choice) {
  const detail::SpineLabels spine = detail::find_spine_labels(labels.patient().label_table, labels.boxes());
  const std::optional<detail::Canal> canal = detail::find_canal(labels, spine);
  if (!canal) return;
  const detail::PosteriorWall wall(labels, spine, *canal);
  detail::derive_canal_contents(labels, spine, *canal, wall, choice);
  detail::derive_spinous_ligaments(labels, spine, *canal, wall, choice);
}

/// Logs the duration of a step.
void timed(const char* name, const std::function<void()>& step) {
  const auto start = std::chrono::steady_clock::now();
  step();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  log_info("derived {} in {:.2f} s", name, seconds.count());
}

}  // namespace

Status check_derived_names(const anatomy::KnownStructures& known) {
  for (const std::string_view name : kDerivable)
    if (known.find(name) == nullptr)
      return fail("the structure \"" + std::string(name) + "\", which is derived, is not known", known.file(),
                  "add the name to an entry [[structures]]");
  return {};
}

std::vector<std::string> derive_structures(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known,
                                           const DeriveChoice& choice, const Progress& progress) {
  if (!choice.is_all && choice.names.empty()) return {};
  const std::size_t before = patient.label_table.labels.size();
  detail::DerivedLabels labels(patient, known);
  report(progress, "thin structures", 0.0);
  const auto is_wanted = [&](std::string_view name) { return choice.has(name); };
  if (std::ranges::any_of(kOfSpine, is_wanted)) timed("structures of the spine", [&] { derive_spine(labels, choice); });
  report(progress, "thin structures", 0.3);
  timed("bile ducts", [&] { detail::derive_bile_ducts(labels, choice); });
  report(progress, "thin structures", 0.5);
  timed("structures of the trunk's wall", [&] { detail::derive_wall_structures(labels, choice); });
  std::vector<std::string> added;
  std::vector<std::uint8_t> ids;
  for (std::size_t n = before; n < patient.label_table.labels.size(); ++n)
    ids.push_back(patient.label_table.labels[n].id);
  labels.finish();
  for (const std::uint8_t id : ids)
    if (const anatomy::Label* label = patient.label_table.find(id)) added.push_back(label->name);
  return added;
}

namespace {

/// The one of kDerivable that a structure's name means, with or without a side; empty: none.
std::string_view derivable_of(std::string_view name) {
  const std::string plain = anatomy::without_side(anatomy::plain_name(name));
  const auto* const found =
      std::ranges::find_if(kDerivable, [&](std::string_view known) { return anatomy::plain_name(known) == plain; });
  return found != std::end(kDerivable) ? *found : std::string_view{};
}

}  // namespace

bool is_derivable(std::string_view name) {
  return !derivable_of(name).empty();
}

DeriveChoice derivable_in(const anatomy::LabelTable& table) {
  DeriveChoice choice{false, {}};
  for (const anatomy::Label& label : table.labels) {
    const std::string_view name = derivable_of(label.name);
    if (!name.empty() && !choice.has(name)) choice.names.emplace_back(name);
  }
  return choice;
}

bool is_marked_derived(std::string_view name) {
  return name.starts_with(kDerivedMark) && is_derivable(name.substr(kDerivedMark.size()));
}

bool DeriveChoice::has(std::string_view name) const noexcept {
  return is_all || std::find(names.begin(), names.end(), name) != names.end();
}

Result<DeriveChoice> parse_derive_choice(std::string_view text) {
  if (text == "all") return DeriveChoice{};
  DeriveChoice choice{false, {}};
  if (text == "none") return choice;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    if (std::find(std::begin(kDerivable), std::end(kDerivable), name) == std::end(kDerivable))
      return fail_usage(fmt::format("\"{}\" is no structure that can be derived", name), std::string(text),
                        fmt::format("give all, none, or some of: {}", fmt::join(kDerivable, ",")));
    if (!choice.has(name)) choice.names.emplace_back(name);
    if (comma == std::string_view::npos) return choice;
    rest = rest.substr(comma + 1);
  }
}

}  // namespace trocar::patient_builder
