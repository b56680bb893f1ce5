// Whether the numbers of a segmentation mean what the label map says, or what another one says.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "patient_builder/plausibility/detail/reading_match.h"
#include "patient_builder/plausibility/judge_anatomy.h"

namespace trocar::patient_builder {
namespace {

using detail::ReadingMatch;

// Points of ReadingMatch. [assumed: no right segmentation among the test data has half as many]
constexpr double kClear = 1.4;   ///< From here on a reading contradicts the CT, as an organ on the other side does.
constexpr double kFits = 1.5;    ///< Up to here it fits.
constexpr double kAsGood = 1.0;  ///< Nothing decides between two that differ by less.
// Numbers that fit nothing: so many structures, and this share of those that can be compared, lie elsewhere.
constexpr std::size_t kFewestMisplaced = 3;
constexpr double kMisplacedShare = 0.34;

struct Fit {
  const OtherReading* reading;
  ReadingMatch match;
};

/// The other readings that fit, and clearly better than the given one; the best first, without those that nothing tells
/// from it by more than kAsGood. Readings of the same names count once.
std::vector<Fit> readings_that_fit(const LabelSource& source, const detail::ValuesInCt& in_ct,
                                   const ReadingMatch& given, const anatomy::KnownStructures& known) {
  std::vector<Fit> fits;
  for (const OtherReading& other : source.other_readings) {
    ReadingMatch match = detail::match_reading(in_ct, other.names, known);
    if (match.against > kFits || match.against - match.agreed + kClear > given.against - given.agreed) continue;
    if (std::ranges::any_of(fits, [&](const Fit& fit) { return fit.reading->names == other.names; })) continue;
    fits.push_back({&other, std::move(match)});
  }
  const auto points = [](const Fit& fit) { return fit.match.against - fit.match.agreed; };
  std::ranges::stable_sort(fits, {}, points);
  if (!fits.empty())
    std::erase_if(fits, [&, best = points(fits.front())](const Fit& fit) { return points(fit) > best + kAsGood; });
  return fits;
}

AnatomyFinding other_numbers(const std::vector<Fit>& fits, const std::string& given_words, const ReadingMatch& given,
                             bool is_turned) {
  std::vector<std::string> words, maps, advices;
  for (const Fit& fit : fits) {
    words.push_back(fit.reading->words);
    maps.push_back(fit.reading->label_map);
    if (!fit.reading->advice.empty()) advices.push_back(fit.reading->advice);
  }
  const std::string how = !advices.empty() ? fmt::format("{}", fmt::join(advices, ", or "))
                                           : fmt::format("build with {}{}", kUseLabelMap,
                                                         fmt::join(maps, std::string(" or ") + kUseLabelMap));
  const char* turned =
      is_turned ? " (or export the labels again, if they are mirrored or turned: so the given numbers fit, too)" : "";
  const bool is_one = fits.size() == 1 && !is_turned;
  return {
      kNumbers,
      fmt::format("the label numbers look like those of {}: so read, they agree with the CT, and as given{} they do "
                  "not ({})",
                  fmt::join(words, " or "), given_words.empty() ? "" : fmt::format(" ({})", given_words),
                  fmt::join(given.most, ", ")),
      fmt::format("{}{}{}, or --confirm {} if the numbers are right", how,
                  is_one ? "" : ", by the program or data set that the file is from", turned, kNumbers),
      true, is_one && advices.empty() ? kUseLabelMap + maps.front() : std::string()};
}

AnatomyFinding unknown_numbers(const std::string& given_words, const ReadingMatch& given) {
  return {kNumbers,
          fmt::format("the label numbers, read as {}, contradict each other ({}), and no other known numbers fit",
                      given_words, fmt::join(given.most, ", ")),
          fmt::format("name them in a TOML file (--label-map names.toml, [labels] 1 = \"liver\" …), or --confirm {} if "
                      "they are right",
                      kNumbers),
          true};
}

std::optional<AnatomyFinding> judge_source(const LabelSource& source, const volume::CtGrid& ct,
                                           const anatomy::KnownStructures& known) {
  const detail::ValuesInCt in_ct = detail::measure_values(ct, source.labels);
  const ReadingMatch given = detail::match_reading(in_ct, source.names, known);
  if (given.against < kClear) return std::nullopt;
  // Mirrored or turned labels are none of wrong numbers.
  const ReadingMatch turned = detail::match_any_direction(in_ct, source.names, known);
  if (const auto fits = readings_that_fit(source, in_ct, given, known); !fits.empty())
    return other_numbers(fits, source.numbers_of, given, turned.against < kClear);
  if (source.numbers_of.empty()) return std::nullopt;
  const bool is_disordered =
      turned.misplaced >= kFewestMisplaced &&
      static_cast<double>(turned.misplaced) >= kMisplacedShare * static_cast<double>(turned.compared);
  return is_disordered ? std::optional(unknown_numbers(source.numbers_of, turned)) : std::nullopt;
}

}  // namespace

std::vector<AnatomyFinding> judge_numbers(const volume::CtGrid& ct, const std::vector<LabelSource>& sources,
                                          const anatomy::KnownStructures& known) {
  std::vector<AnatomyFinding> findings;
  for (const LabelSource& source : sources) {
    if (source.other_readings.empty() && source.numbers_of.empty()) continue;
    if (auto finding = judge_source(source, ct, known)) findings.push_back(*std::move(finding));
  }
  return findings;
}

}  // namespace trocar::patient_builder
