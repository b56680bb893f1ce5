// The description of a tick (telemetry/tick_fields.h) against the schema, and a tick's way through the wire's struct.
#include "link/detail/wire_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "link/test/fingerprint.h"
#include "link/test/random_message.h"

namespace trocar::link::detail {
namespace {

/// A field of a struct of the schema, as flatc describes it.
struct SchemaField {
  std::string name, type;
  std::size_t offset;
  bool operator==(const SchemaField&) const = default;
};
void PrintTo(const SchemaField& field, std::ostream* out) {
  *out << field.name << ": " << field.type << " at " << field.offset;
}

/// "double", "struct", "uint8", "bool", with [] for an array; an enumeration by the type of its numbers.
std::string type_text(const flatbuffers::TypeCode& code) {
  std::string text;
  switch (static_cast<flatbuffers::ElementaryType>(code.base_type)) {
    case flatbuffers::ET_DOUBLE:
      text = "double";
      break;
    case flatbuffers::ET_UCHAR:
      text = code.sequence_ref >= 0 ? "enum" : "uint8";
      break;
    case flatbuffers::ET_BOOL:
      text = "bool";
      break;
    case flatbuffers::ET_SEQUENCE:
      text = "struct";
      break;
    default:
      text = "another type";
  }
  return code.is_repeating ? text + "[]" : text;
}

std::vector<SchemaField> schema_fields() {
  const flatbuffers::TypeTable& table = *wire::SampleTypeTable();
  std::vector<SchemaField> fields;
  for (std::size_t i = 0; i < table.num_elems; ++i)
    fields.push_back({table.names[i], type_text(table.type_codes[i]), static_cast<std::size_t>(table.values[i])});
  return fields;
}

template <class Value>
std::string type_text(const Value&) {
  if constexpr (std::is_same_v<Value, double>) return "double";
  if constexpr (std::is_same_v<Value, Vec3>) return "struct";
  if constexpr (std::is_same_v<Value, telemetry::Quaternion>) return "double[]";
  if constexpr (std::is_same_v<Value, telemetry::TickEvents>) return "struct[]";
  if constexpr (std::is_same_v<Value, std::uint8_t>) return "uint8";
  if constexpr (std::is_same_v<Value, bool>) return "bool";
  return "enum";
}

TEST(WireSample, SchemaMatchesTheTickFields) {
  const telemetry::TickSample sample;
  std::vector<SchemaField> described;
  for_each_wire_field([&](const auto& field, std::size_t offset) {
    described.push_back({field.name, type_text(sample.*field.member), offset});
  });
  std::ranges::sort(described, {}, &SchemaField::offset);
  EXPECT_EQ(described, schema_fields());
}

TEST(WireSample, RoundTripsEveryFieldBitwise) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto sample = RandomMessages(seed).some<telemetry::TickSample>();
    Inspection inspection(0);
    telemetry::TickSample read;
    read_sample(to_wire(sample), inspection, read);
    EXPECT_EQ(Fingerprint(read), Fingerprint(sample)) << "seed " << seed;
    EXPECT_TRUE(inspection.is_valid());
  }
}

TEST(WireSample, MatchesTheOffsetsOfGeneratedAccessors) {
  const auto sample = RandomMessages(41).some<telemetry::TickSample>();
  const wire::Sample packed = to_wire(sample);
  EXPECT_EQ(packed.time_s(), sample.time_s);
  EXPECT_EQ(from_wire(packed.tip_mm()), sample.tip_mm);
  EXPECT_EQ(packed.device_rotation_wxyz()->Get(2), sample.device_rotation_wxyz[2]);
  EXPECT_EQ(packed.events()->Get(3)->id(), sample.events[3].id);
  EXPECT_EQ(static_cast<int>(packed.gate_fault()), static_cast<int>(sample.gate_fault));
}

}  // namespace
}  // namespace trocar::link::detail
