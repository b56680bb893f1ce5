#include "anatomy/tissue/tissue_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/toml.h"

namespace trocar::anatomy {
namespace {

/// Uncertainty of every value of an assumed curve, as factors around 1.
constexpr std::string_view kFactors = "factors";
constexpr config::Range kFactorRange{0.01, 100.0};

std::string path_of(std::string_view field) {
  return fmt::format("{}.{}", kTransfer, field);
}

Status read_knots(const config::TomlTable& section, HuTransfer& transfer) {
  TROCAR_TRY(const std::vector<double> knots, section.numbers("hu", kHuRange));
  if (knots.size() < 2 || knots.size() > HuTransfer::kMaxKnots)
    return fail(fmt::format("hu has {} knots", knots.size()), section.where(),
                fmt::format("give 2 to {}", HuTransfer::kMaxKnots));
  for (std::size_t n = 1; n < knots.size(); ++n)
    if (!(knots[n] > knots[n - 1]))
      return fail(fmt::format("hu must increase: {} follows {}", knots[n], knots[n - 1]), section.where(),
                  "order the knots by HU");
  std::copy(knots.begin(), knots.end(), transfer.hu.begin());
  transfer.knot_count = knots.size();
  return {};
}

/// KEY = {values = [one per knot], source = "…", factors = [0.5, 2.0]}.
Status read_curve(const config::TomlTable& section, const TissueField<HuLaw>& field, TissueTable& table) {
  HuTransfer& transfer = table.transfer;
  TROCAR_TRY(const config::TomlTable entry, section.table(field.name));
  TROCAR_TRY_STATUS(entry.check_keys({"values", "source", kFactors}));
  TROCAR_TRY(const std::vector<double> values, entry.numbers("values", field.range));
  if (values.size() != transfer.knot_count)
    return fail(fmt::format("{} values for {} knots", values.size(), transfer.knot_count), entry.where(),
                "give one value for each knot of hu");
  for (std::size_t n = 0; n < values.size(); ++n) transfer.laws[n].*field.member = values[n];

  Provenance provenance;
  TROCAR_TRY(provenance.source, entry.string("source"));
  if (provenance.source.empty()) return fail("the source is empty", entry.where(), "say where the numbers come from");
  if (entry.has(kFactors)) {
    TROCAR_TRY(const std::vector<double> factors, entry.numbers(kFactors, kFactorRange));
    if (factors.size() != 2 || factors[0] > 1.0 || factors[1] < 1.0)
      return fail("factors must be [low, high] around 1", entry.where(),
                  "give a low factor of at most 1 and a high factor of at least 1");
    provenance.low = factors[0];
    provenance.high = factors[1];
  } else if (provenance.source.starts_with("assumed")) {
    return fail("an assumed curve must give its uncertainty factors", entry.where(), "add factors = [0.5, 2]");
  }
  table.provenance[path_of(field.name)] = std::move(provenance);
  return {};
}

Status read_gradient_number(const config::TomlTable& section, const TissueField<HuTransfer>& field,
                            TissueTable& table) {
  TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(section, field.name, field.range));
  table.transfer.*field.member = number.value;
  Provenance provenance{number.source, {}, {}};
  if (number.range) {
    provenance.low = number.range->low;
    provenance.high = number.range->high;
  }
  table.provenance[path_of(field.name)] = std::move(provenance);
  return {};
}

}  // namespace

Status read_hu_transfer(const config::TomlTable& document, TissueTable& table) {
  if (!document.has(kTransfer)) return {};
  TROCAR_TRY(const config::TomlTable section, document.table(kTransfer));
  std::vector<std::string_view> known = {"hu"};
  for (const auto& field : kHuLawFields) known.push_back(field.name);
  for (const auto& field : kGradientFields) known.push_back(field.name);
  TROCAR_TRY_STATUS(section.check_keys(known));
  TROCAR_TRY_STATUS(read_knots(section, table.transfer));
  for (const auto& field : kHuLawFields) TROCAR_TRY_STATUS(read_curve(section, field, table));
  for (const auto& field : kGradientFields) TROCAR_TRY_STATUS(read_gradient_number(section, field, table));
  if (!(table.transfer.gradient_full_hu_per_mm > table.transfer.gradient_none_hu_per_mm))
    return fail("gradient_full_hu_per_mm must be above gradient_none_hu_per_mm", section.where(),
                "raise gradient_full_hu_per_mm");
  return {};
}

void write_hu_transfer(config::TomlWriter& writer, const TissueTable& table) {
  const HuTransfer& transfer = table.transfer;
  if (transfer.knot_count == 0) return;
  writer.begin_table({kTransfer});
  writer.set("hu", std::vector<double>(transfer.hu.begin(), transfer.hu.begin() + transfer.knot_count));
  for (const auto& field : kHuLawFields) {
    std::vector<double> values;
    for (std::size_t n = 0; n < transfer.knot_count; ++n) values.push_back(transfer.laws[n].*field.member);
    const Provenance source = find_provenance(table.provenance, path_of(field.name));
    std::vector<config::TomlValue::Entry> curve{{"values", values}, {"source", source.source}};
    if (source.low && source.high) curve.push_back({kFactors, std::vector<double>{*source.low, *source.high}});
    writer.set(field.name, curve);
  }
  for (const auto& field : kGradientFields)
    write_number(writer, field.name, transfer.*field.member, path_of(field.name), table.provenance);
}

}  // namespace trocar::anatomy
