#include "link/detail/inspection.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/text.h"
#include "link/messages.h"

namespace trocar::link::detail {
namespace {

constexpr double kRotationTolerance = 1e-6;   ///< Tolerance of the entries of R^T R, and of the determinant.
constexpr double kRoundingTolerance = 1e-12;  ///< Below this, a rotation is unchanged, bit for bit.

double rotation_error(const Mat3& R) {
  const double skewness = (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
  return std::max(skewness, std::abs(R.determinant() - 1.0));
}

}  // namespace

void Inspection::refuse(std::string what, const char* field) {
  if (complaint_) return;
  complaint_ = Error{std::move(what), fmt::format("message over the link, field {}", field), "", 1};
}

std::string Inspection::text(const flatbuffers::String* text, const char* field, Layout layout) {
  if (text == nullptr || complaint_) return {};
  const std::string_view view(text->c_str(), text->size());
  if (view.size() > kMostTextBytes) {
    refuse(fmt::format("a text of {} bytes, {} are allowed", view.size(), kMostTextBytes), field);
  } else if (view.size() > text_budget_) {
    refuse("more text than the message has bytes", field);
  } else if (!is_plain_text(view, layout)) {
    refuse("a text that is not UTF-8 or has control characters", field);
  } else {
    text_budget_ -= view.size();
    return std::string(view);
  }
  return {};
}

std::vector<std::string> Inspection::texts(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list,
                                           const char* field) {
  std::vector<std::string> lines;
  if (list == nullptr || complaint_) return lines;
  if (!has_room(list->size(), kMostSettings, field)) return lines;
  for (const flatbuffers::String* line : *list) {
    lines.push_back(text(line, field));
    if (complaint_) return {};
  }
  return lines;
}

bool Inspection::has_room(std::size_t items, std::size_t most, const char* field) {
  if (items <= most) return true;
  refuse(fmt::format("more items than a list may have: {}, {} are allowed", items, most), field);
  return false;
}

double Inspection::number(double value, Range range, const char* field) {
  if (value >= range.low && value <= range.high) return value;  // false for NaN
  refuse(fmt::format("{} is not a number in {:g} to {:g}", value, range.low, range.high), field);
  return 0.0;
}

int Inspection::whole_number(std::int32_t value, int low, int high, const char* field) {
  if (value >= low && value <= high) return value;
  refuse(fmt::format("{} is not in {} to {}", value, low, high), field);
  return low;
}

Vec3 Inspection::vector(const Vec3& vector, double longest, const char* field) {
  if (vector.squaredNorm() <= longest * longest) return vector;  // false for NaN
  refuse(fmt::format("not a vector of at most {:g}", longest), field);
  return Vec3::Zero();
}

Vec3 Inspection::vector(const wire::Vec3& packed, double longest, const char* field) {
  return vector(from_wire(packed), longest, field);
}

Pose Inspection::pose(const wire::Pose& pose, const char* field) {
  const Vec3 p = vector(pose.position(), kMostPosition_mm, field);
  Mat3 R;
  for (flatbuffers::uoffset_t i = 0; i < 9; ++i) R(i / 3, i % 3) = pose.rotation()->Get(i);
  const double error = rotation_error(R);
  if (!R.allFinite() || !(error <= kRotationTolerance)) {
    refuse("not a rotation", field);
    return {};
  }
  if (error > kRoundingTolerance) R = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  return {R, p};
}

wire::Pose to_wire(const Pose& pose) {
  std::array<double, 9> rotation;
  for (int i = 0; i < 9; ++i) rotation[static_cast<std::size_t>(i)] = pose.R()(i / 3, i % 3);
  return {flatbuffers::span<const double, 9>(rotation.data(), rotation.size()), to_wire(pose.p())};
}

namespace {

bool is_control(char32_t c, Layout layout) {
  if (c == '\t' || c == '\n' || c == '\r') return layout == Layout::kLine;
  return c < 0x20 || (c >= 0x7F && c < 0xA0);
}

}  // namespace

bool is_plain_text(std::string_view text, Layout layout) {
  while (!text.empty()) {
    const auto character = first_character(text);
    if (!character || is_control(character->code_point, layout)) return false;
    text.remove_prefix(character->bytes);
  }
  return true;
}

namespace {

constexpr flatbuffers::uoffset_t kMostDepth = 4;  ///< Root, Command, SetParameters, TissueSetting.
constexpr flatbuffers::uoffset_t kMostTables = kMostSettings + 8;

}  // namespace

AlignedBytes::AlignedBytes(std::span<const std::byte> bytes)
    : words_((bytes.size() + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t)), size_(bytes.size()) {
  if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
}

flatbuffers::Verifier make_verifier(const AlignedBytes& bytes) {
  return flatbuffers::Verifier(bytes.data(), bytes.size(), kMostDepth, kMostTables);
}

Status check_size(std::size_t bytes) {
  if (bytes == 0) return fail("an empty message", "link", "check the program on the other side");
  if (bytes > kMostMessageBytes) {
    return fail(fmt::format("a message of {} bytes, {} are allowed", bytes, kMostMessageBytes), "link",
                "send smaller messages");
  }
  return {};
}

Status check_frame(const AlignedBytes& bytes, const char* identifier) {
  flatbuffers::Verifier verifier = make_verifier(bytes);
  if (!verifier.VerifyBuffer<wire::Prelude>(identifier)) {
    const bool is_client = std::strcmp(identifier, kClientIdentifier) == 0;
    return fail(fmt::format("not a message of a {}, or a damaged one", is_client ? "client" : "server"), "link",
                "check that the other side is a Trocar program");
  }
  const std::uint32_t version = flatbuffers::GetRoot<wire::Prelude>(bytes.data())->version();
  if (version != kLinkVersion) {
    return fail(
        fmt::format("the other side speaks version {} of the link, this program version {}", version, kLinkVersion),
        "link", "install the same version of Trocar on both sides");
  }
  return {};
}

Bytes take_bytes(const flatbuffers::FlatBufferBuilder& builder) {
  const auto* begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  return {begin, begin + builder.GetSize()};
}

}  // namespace trocar::link::detail
